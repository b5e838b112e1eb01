#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/byte_stream.h"
#include "hgmm/mixture.h"
#include "mixture/regularized.h"

/// What the compact forms of all components have in common.
namespace hgmm {

/// Positive numbers on a logarithmic scale of `codes` steps.
struct LogScale {
    double low, high;
    int codes;

    int encode(double v) const;
    double decode(int code) const;
};

/// A cube with edges of 16 m, by its place in their lattice.
using Block = std::array<std::int32_t, 3>;

/// The block that holds p.
Block blockOf(const Eigen::Vector3d& p);

/// The 17 bytes of a component's mean, covariance and support (see encodeSurfaces).
void putPlace(Writer& out, const Block& block, const Eigen::Vector3d& mean,
              const Eigen::Matrix3d& covariance, double support);
void getPlace(Reader& in, const Block& block, Gaussian<3>& g);

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
    Gaussian<D> g = regularized(component);
    g.support = static_cast<float>(g.support);
    g.mean = g.mean.template cast<float>().template cast<double>().eval();
    g.covariance = g.covariance.template cast<float>().template cast<double>().eval();
    return g;
}

/// Appends the record of a component, chosen so that what is read from it has the same
/// record again. Where rounding to float moves a component across the edge of a step, it
/// is followed until it stays; one that does not, at the limits of float, is widened, twice
/// as much each time, until it is round enough.
template <typename Component>
void putStable(std::vector<std::uint8_t>& bytes, const Block& block, Component component) {
    constexpr int kFollow = 8, kGiveUp = 64;
    double wider = 1e-6;
    std::vector<std::uint8_t> record, again;
    Writer recordOut(record);
    putRecord(recordOut, block, component);
    for (int round = 0; round < kGiveUp; ++round) {
        Reader in(record.data(), record.size());
        getRecord(in, block, component);
        if (round >= kFollow) {
            auto variances = component.g.covariance.diagonal();
            auto place = variances.template head<3>();
            place.array() += wider * place.sum();
            variances.tail(variances.size() - 3) *= 1.0 + wider;
            wider = std::min(2 * wider, 1.0);
        }
        again.clear();
        Writer out(again);
        putRecord(out, block, component);
        if (again == record) break;
        record.swap(again);
    }
    bytes.insert(bytes.end(), record.begin(), record.end());
}

}  // namespace hgmm
