#include "random_input.h"

#include <algorithm>
#include <limits>
#include <random>

namespace hgmm::fuzz {

namespace {

using Random = std::mt19937_64;

Eigen::Vector3d inCube(Random& random) {
    std::uniform_real_distribution<double> side(-1.0, 1.0);
    return {side(random), side(random), side(random)};
}

/// A point of a shape about one unit large.
Eigen::Vector3d pointOn(unsigned shape, Random& random) {
    Eigen::Vector3d p = inCube(random);
    switch (shape) {
        case 0: {  // walls, floor and ceiling around the sensor
            const auto axis = static_cast<int>(random() % 3);
            p[axis] = p[axis] < 0 ? -1.0 : 1.0;
            return p;
        }
        case 1:  // a plane in front of it
            return {1.0, p.y(), p.z()};
        case 2:  // a plane through it
            return {p.x(), p.y(), 0.0};
        case 3:  // a line
            return {1.0, p.y(), 0.5};
        case 4:  // one place
            return {0.5, 0.25, 0.125};
        case 5: {  // a planar laser in a room
            const double m = std::max(std::abs(p.x()), std::abs(p.y()));
            return {p.x() / m, p.y() / m, 0.0};
        }
        default:  // a cloud
            return p;
    }
}

void addChannels(Scan& scan, Bytes& bytes, Random& random) {
    const unsigned kinds = bytes.below(8);
    const char* const names[] = {"r", "g", "heat"};
    std::uniform_real_distribution<float> value(0.F, 1.F);
    for (unsigned c = 0; c < 3; ++c) {
        if ((kinds >> c & 1U) == 0) continue;
        Channel channel{names[c], {}};
        const auto scale = static_cast<float>(c == 2 ? bytes.magnitude(1e-6, 1e6) : 1.0);
        for (std::size_t i = 0; i < scan.size(); ++i)
            channel.values.push_back(scale * (value(random) + 0.1F * scan.x[i]));
        if (bytes.below(4) == 0 && scan.size() > 0)
            channel.values[random() % scan.size()] =
                std::numeric_limits<float>::quiet_NaN();
        scan.channels.push_back(std::move(channel));
    }
}

}  // namespace

Scan scanFrom(Bytes& bytes) {
    constexpr unsigned kShapes = 8, kBytesThemselves = 7;
    Scan scan;
    const unsigned shape = bytes.below(kShapes);
    Random random(bytes.raw<std::uint16_t>());
    if (shape == kBytesThemselves) {
        for (unsigned n = bytes.below(24); n > 0; --n) {
            const auto px = bytes.raw<float>(), py = bytes.raw<float>();
            scan.pushBack(px, py, bytes.raw<float>());
        }
    } else {
        const bool isUsual = bytes.below(4) > 0;
        const double size = isUsual ? bytes.magnitude(0.5, 50) : bytes.magnitude(1e-3, 1e5);
        const double noise =
            bytes.coin() ? bytes.between(0, 1) : 0.01 * bytes.between(0, 1);
        std::normal_distribution<double> error(0.0, 1.0);
        const unsigned points = 1 + 2 * bytes.below(200);
        for (unsigned i = 0; i < points; ++i) {
            Eigen::Vector3d p = size * pointOn(shape, random);
            if (shape != 4) p += noise * Eigen::Vector3d(error(random), error(random), 0.0);
            scan.pushBack(float(p.x()), float(p.y()), float(p.z()));
        }
    }
    addChannels(scan, bytes, random);
    for (unsigned n = bytes.below(4); n > 1; --n) {
        const Eigen::Vector3f u = inCube(random).normalized().cast<float>();
        scan.clearedRays.push_back({u, static_cast<float>(bytes.magnitude(1e-3, 1e6))});
    }
    return scan;
}

Pose poseFrom(Bytes& bytes) {
    Pose pose;
    const unsigned kind = bytes.below(16);
    const auto axis = [&bytes] { return bytes.between(-1, 1); };
    Eigen::Quaterniond q(axis(), axis(), axis(), axis());
    if (q.norm() > 1e-3) pose.R = q.normalized().toRotationMatrix();
    const double reach = kind < 11   ? 3.0
                         : kind < 14 ? bytes.magnitude(1e-3, 1e7)
                         : kind < 15 ? bytes.magnitude(1e7, 1e39)
                                     : 3.0;
    for (int d = 0; d < 3; ++d) pose.t[d] = reach * axis();
    if (kind == 15 && bytes.below(8) == 0) pose.R(0, 0) = bytes.raw<double>();
    return pose;
}

MapParams paramsFrom(Bytes& bytes) {
    MapParams params;
    for (unsigned edits = bytes.below(8); edits > 0; --edits) {
        const unsigned chosen = bytes.raw<std::uint8_t>();
        const double share = bytes.between(0, 1);
        unsigned k = 0, count = 0;
        forEachNumber(params, [&](const OptionRow&, auto&) { ++count; });
        forEachNumber(params, [&](const OptionRow& row, auto& value) {
            if (k++ != chosen % count) return;
            const double low = std::max(row.low, 1e-9 * row.high);
            using Value = std::remove_reference_t<decltype(value)>;
            value = static_cast<Value>(
                std::clamp(low * std::pow(row.high / low, share), row.low, row.high));
        });
    }
    params.hierarchy.levels = std::min(params.hierarchy.levels, 5);
    params.em.maxIterations = std::min(params.em.maxIterations, 10);
    params.filter.maxRange_m = std::max(params.filter.maxRange_m, params.filter.minRange_m);
    OccupancyParams& occupancy = params.occupancy;
    occupancy.extentSigmas = std::min(occupancy.extentSigmas, occupancy.knownSigmas);
    const unsigned channels = bytes.below(8);
    for (unsigned c = 0; c < 3; ++c)
        if ((channels >> c & 1U) != 0)
            params.modalities.emplace_back(c == 0 ? "r" : c == 1 ? "g" : "heat");
    return params;
}

}  // namespace hgmm::fuzz
