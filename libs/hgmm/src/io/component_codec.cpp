#include "io/component_codec.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hgmm/regression.h"
#include "io/place_codec.h"

namespace hgmm {

namespace {

constexpr LogScale kRange{0.05, 1e4, 255};
constexpr LogScale kDistance{1e-3, 1e4, 256};

/// Unit vectors on the faces of an octahedron, unfolded to a square [-1, 1]^2.
void putDirection(Writer& out, const Eigen::Vector3d& u) {
    const double sum = u.cwiseAbs().sum();
    double a = u.x() / sum, b = u.y() / sum;
    if (u.z() < 0) {
        const double folded = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
        b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
        a = folded;
    }
    for (const double v : {a, b})
        out.put(static_cast<std::int8_t>(std::lround(std::clamp(v, -1.0, 1.0) * 127)));
}

Eigen::Vector3d getDirection(Reader& in) {
    double a = in.get<std::int8_t>() / 127.0, b = in.get<std::int8_t>() / 127.0;
    const double z = 1 - std::abs(a) - std::abs(b);
    if (z < 0) {
        const double unfolded = (1 - std::abs(b)) * (a < 0 ? -1 : 1);
        b = (1 - std::abs(a)) * (b < 0 ? -1 : 1);
        a = unfolded;
    }
    return Eigen::Vector3d(a, b, z).normalized();
}

struct Surface {
    Gaussian<3> g;
    ViewDirection view;
};

void putRecord(Writer& out, const Block& block, const Surface& surface) {
    const auto& [g, view] = surface;
    putPlace(out, block, g.mean, g.covariance, g.support);
    putDirection(out, view.known() ? view.direction : Eigen::Vector3d::UnitZ());
    out.put(static_cast<std::uint8_t>(view.known() ? 1 + kRange.encode(view.range_m) : 0));
}

void getRecord(Reader& in, const Block& block, Surface& surface) {
    auto& [g, view] = surface;
    getPlace(in, block, g);
    g = asStored(g);
    view.direction = getDirection(in).cast<float>().cast<double>();
    const auto range = in.get<std::uint8_t>();
    if (range == 0) view.direction.setZero();
    view.range_m = range > 0 ? static_cast<float>(kRange.decode(range - 1)) : 0.0;
}

struct FreeComponent {
    Gaussian<4> g;
    int octave = 0;
};

void putRecord(Writer& out, const Block& block, const FreeComponent& component) {
    const auto& [g, octave] = component;
    const RegressedGaussian<4> w(g, 1.0);
    putPlace(out, block, g.mean.head<3>(), g.covariance.topLeftCorner<3, 3>(), g.support);
    out.put(static_cast<std::int8_t>(octave));
    out.put(static_cast<std::uint8_t>(kDistance.encode(g.mean[3])));
    for (int d = 0; d < 3; ++d)
        out.put(static_cast<std::int8_t>(
            std::lround(std::clamp(w.slope(d) * 100, -127.0, 127.0))));
    out.put(static_cast<std::uint8_t>(kDistance.encode(std::sqrt(w.variance()))));
}

void getRecord(Reader& in, const Block& block, FreeComponent& component) {
    Gaussian<3> place;
    getPlace(in, block, place);
    component.octave = in.get<std::int8_t>();
    Gaussian<4>& g = component.g;
    g.support = place.support;
    g.mean.head<3>() = place.mean;
    g.mean[3] = kDistance.decode(in.get<std::uint8_t>());
    Eigen::Vector3d slope;
    for (int d = 0; d < 3; ++d) slope[d] = in.get<std::int8_t>() / 100.0;
    const double sigma = kDistance.decode(in.get<std::uint8_t>());
    const Eigen::Vector3d cross = place.covariance * slope;
    g.covariance.topLeftCorner<3, 3>() = place.covariance;
    g.covariance.topRightCorner<3, 1>() = cross;
    g.covariance.bottomLeftCorner<1, 3>() = cross.transpose();
    g.covariance(3, 3) = sigma * sigma + slope.dot(cross);
    g = asStored(g);
}

}  // namespace

template <int D>
std::vector<std::uint32_t> blockOrder(const Mixture<D>& mixture) {
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < mixture.size(); ++i) blocks.push_back(blockOf(mixture, i));
    std::vector<std::uint32_t> order(mixture.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return blocks[a] < blocks[b];
    });
    return order;
}
template std::vector<std::uint32_t> blockOrder(const Mixture<3>&);
template std::vector<std::uint32_t> blockOrder(const Mixture<4>&);

void encodeSurfaces(const Mixture<3>& mixture, const ViewDirections& views,
                    const std::vector<std::uint32_t>& order,
                    std::vector<std::uint8_t>& bytes) {
    forEachBlock(mixture, order, bytes, [&](const Block& block, std::size_t i) {
        putStable(bytes, block, Surface{mixture[i], views[i]});
    });
}

std::size_t decodeSurfaces(const std::uint8_t* data, std::size_t size, Mixture<3>& mixture,
                           ViewDirections& views) {
    Reader in(data, size);
    readBlocks(in, [&](const Block& block) {
        Surface surface;
        getRecord(in, block, surface);
        mixture.pushBack(surface.g);
        views.pushBack(surface.view);
    });
    return size - in.left();
}

void encodeFree(const Mixture<4>& mixture, const std::vector<int>& octaves,
                const std::vector<std::uint32_t>& order, std::vector<std::uint8_t>& bytes) {
    forEachBlock(mixture, order, bytes, [&](const Block& block, std::size_t i) {
        putStable(bytes, block, FreeComponent{mixture[i], octaves[i]});
    });
}

std::size_t decodeFree(const std::uint8_t* data, std::size_t size, Mixture<4>& mixture,
                       std::vector<int>& octaves) {
    Reader in(data, size);
    readBlocks(in, [&](const Block& block) {
        FreeComponent component;
        getRecord(in, block, component);
        mixture.pushBack(component.g);
        octaves.push_back(component.octave);
    });
    return size - in.left();
}

}  // namespace hgmm
