#include "component_codec.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "byte_stream.h"
#include "hgmm/conditional.h"
#include "storable.h"

namespace hgmm {

namespace {

constexpr double kBlock_m = 16.0;

/// Positive numbers on a logarithmic scale of `codes` steps.
struct LogScale {
    double low, high;
    int codes;

    int encode(double v) const {
        const double position = std::log(v / low) / std::log(high / low) * (codes - 1);
        return position > 0 ? static_cast<int>(std::lround(std::min(position, codes - 1.0)))
                            : 0;
    }
    double decode(int code) const {
        return low * std::exp(std::log(high / low) * code / (codes - 1));
    }
};

constexpr LogScale kSigma{5e-4, 500.0, 256};
/// The factor's other entries, in steps of a share of their row's diagonal entry, which is
/// their scale: so the error is a share of the component's thickness, and what rounding to
/// float does to them stays below half a step.
constexpr double kStepsPerDiagonal = 32.0;
constexpr double kMaxPerDiagonal = 950.0;
constexpr LogScale kSupport{1e-6, 1e12, 65536};
constexpr LogScale kRange{0.05, 1e4, 255};
constexpr LogScale kDistance{1e-3, 1e4, 256};

using Block = std::array<std::int32_t, 3>;

Block blockOf(const Eigen::Vector3d& p) {
    Block b;
    for (int d = 0; d < 3; ++d)
        b[d] = static_cast<std::int32_t>(std::floor(p[d] / kBlock_m));
    return b;
}

void putPlace(Writer& out, const Block& block, const Eigen::Vector3d& mean,
              const Eigen::Matrix3d& covariance, double support) {
    for (int d = 0; d < 3; ++d) {
        const double inside = mean[d] / kBlock_m - block[d];
        out.put(static_cast<std::uint16_t>(std::clamp(inside * 65536, 0.0, 65535.0)));
    }
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    std::array<double, 3> diagonal{};
    for (int d = 0; d < 3; ++d) {
        const double beside = L.row(d).head(d).cwiseAbs().sum();
        const int code = kSigma.encode(std::max(L(d, d), beside / kMaxPerDiagonal));
        diagonal[d] = kSigma.decode(code);
        out.put(static_cast<std::uint8_t>(code));
    }
    // Slopes of one axis over another, not the entries themselves: a slope must be good to
    // the thickness of the component over its length, whatever became of the diagonal.
    const auto putSlope = [&](int row, int col, double slope) {
        const double perStep = diagonal[row] / diagonal[col] / kStepsPerDiagonal;
        const auto steps = static_cast<std::int16_t>(
            std::lround(std::clamp(slope / perStep, -32767.0, 32767.0)));
        out.put(steps);
        return steps * perStep;
    };
    const double slope10 = L(1, 0) / L(0, 0), slope21 = L(2, 1) / L(1, 1);
    const double error10 = putSlope(1, 0, slope10) - slope10;
    // Axis 2 follows axis 1, and so what axis 1 lost on its way over axis 0.
    putSlope(2, 0, L(2, 0) / L(0, 0) + slope21 * error10);
    putSlope(2, 1, slope21);
    out.put(static_cast<std::uint16_t>(kSupport.encode(support)));
}

void getPlace(Reader& in, const Block& block, Gaussian<3>& g) {
    for (int d = 0; d < 3; ++d)
        g.mean[d] = (block[d] + (in.get<std::uint16_t>() + 0.5) / 65536) * kBlock_m;
    Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
    for (int d = 0; d < 3; ++d) L(d, d) = kSigma.decode(in.get<std::uint8_t>());
    for (int row = 1; row < 3; ++row)
        for (int col = 0; col < row; ++col)
            L(row, col) = in.get<std::int16_t>() / kStepsPerDiagonal * L(row, row);
    g.covariance = L * L.transpose();
    g.support = kSupport.decode(in.get<std::uint16_t>());
}

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

template <int D>
Block blockOf(const Mixture<D>& mixture, std::size_t i) {
    return blockOf(
        Eigen::Vector3d(mixture.mean[0][i], mixture.mean[1][i], mixture.mean[2][i]));
}

/// Calls record(block, i) for each component in the order given, of which each run within
/// one block shares a head.
template <int D, typename Record>
void forEachBlock(const Mixture<D>& mixture, const std::vector<std::uint32_t>& order,
                  std::vector<std::uint8_t>& bytes, Record&& record) {
    struct Run {
        Block block;
        std::uint32_t members;
    };
    std::vector<Run> runs;
    for (const std::uint32_t i : order) {
        const Block block = blockOf(mixture, i);
        if (runs.empty() || runs.back().block != block) runs.push_back({block, 0});
        ++runs.back().members;
    }
    Writer out(bytes);
    out.put(static_cast<std::uint32_t>(runs.size()));
    auto next = order.begin();
    for (const Run& run : runs) {
        for (const std::int32_t v : run.block) out.put(v);
        out.put(run.members);
        for (std::uint32_t m = 0; m < run.members; ++m) record(run.block, *next++);
    }
}

template <typename Record>
void readBlocks(Reader& in, Record&& record) {
    const auto blocks = in.get<std::uint32_t>();
    for (std::uint32_t b = 0; b < blocks; ++b) {
        Block block;
        for (std::int32_t& v : block) v = in.get<std::int32_t>();
        const auto members = in.get<std::uint32_t>();
        for (std::uint32_t m = 0; m < members; ++m) record(block);
    }
}

/// As a Mixture holds it.
template <int D>
Gaussian<D> asStored(const Gaussian<D>& component) {
    Gaussian<D> g = storable(component);
    g.support = static_cast<float>(g.support);
    g.mean = g.mean.template cast<float>().template cast<double>().eval();
    g.covariance = g.covariance.template cast<float>().template cast<double>().eval();
    return g;
}

struct Surface {
    Gaussian<3> g;
    View view;
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

/// Appends the record of a component, chosen so that what is read from it has the same
/// record again. Where rounding to float moves a component across the edge of a step, it
/// is followed until it stays; one that does not, at the limits of float, is widened.
template <typename Component>
void putStable(std::vector<std::uint8_t>& bytes, const Block& block, Component component) {
    constexpr int kFollow = 8, kGiveUp = 64;
    std::vector<std::uint8_t> record, again;
    Writer recordOut(record);
    putRecord(recordOut, block, component);
    for (int round = 0; round < kGiveUp; ++round) {
        Reader in(record.data(), record.size());
        getRecord(in, block, component);
        if (round >= kFollow) {
            auto place = component.g.covariance.diagonal().template head<3>();
            place.array() += 1e-6 * place.sum();
        }
        again.clear();
        Writer out(again);
        putRecord(out, block, component);
        if (again == record) break;
        record.swap(again);
    }
    bytes.insert(bytes.end(), record.begin(), record.end());
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

void encodeSurfaces(const Mixture<3>& mixture, const Views& views,
                    const std::vector<std::uint32_t>& order,
                    std::vector<std::uint8_t>& bytes) {
    forEachBlock(mixture, order, bytes, [&](const Block& block, std::size_t i) {
        putStable(bytes, block, Surface{mixture[i], views[i]});
    });
}

std::size_t decodeSurfaces(const std::uint8_t* data, std::size_t size, Mixture<3>& mixture,
                           Views& views) {
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
