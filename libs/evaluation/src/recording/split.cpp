#include "hgmm/evaluation/split.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace hgmm::evaluation {
namespace {

/// Fraction `f` of `total`, to the nearest count.
std::size_t countOf(double f, std::size_t total) {
    return static_cast<std::size_t>(std::llround(f * static_cast<double>(total)));
}

/// The indices below `total` that are not in `chosen` (rising).
std::vector<std::size_t> complement(const std::vector<std::size_t>& chosen,
                                    std::size_t total) {
    std::vector<std::size_t> rest;
    rest.reserve(total - chosen.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < total; ++i) {
        if (next < chosen.size() && chosen[next] == i)
            ++next;
        else
            rest.push_back(i);
    }
    return rest;
}

}  // namespace

void SplitParams::validate() const {
    if (every < 0 || every == 1)
        throw std::invalid_argument(
            "split must be 0 (no test scans) or at least 2, but is " +
            std::to_string(every));
    if (!(subsample > 0.0 && subsample <= 1.0))
        throw std::invalid_argument("subsample must be in (0, 1], but is " +
                                    std::to_string(subsample));
    if (!(holdoutPoints >= 0.0 && holdoutPoints < 1.0))
        throw std::invalid_argument("holdout-points must be in [0, 1), but is " +
                                    std::to_string(holdoutPoints));
}

bool SplitParams::isTestScan(std::size_t scanIndex) const {
    if (every == 0) return false;
    const auto K = static_cast<std::size_t>(every);
    return scanIndex % K == K / 2;
}

std::mt19937_64 randomStream(std::uint64_t seed, std::size_t scanIndex, Draw draw) {
    std::seed_seq sequence{seed, seed >> 32U, static_cast<std::uint64_t>(scanIndex),
                           static_cast<std::uint64_t>(draw)};
    return std::mt19937_64(sequence);
}

double nextUniform(std::mt19937_64& stream) {
    return static_cast<double>(stream() >> 11U) * 0x1p-53;
}

double nextNormal(std::mt19937_64& stream) {
    constexpr double kTwoPi = 6.283185307179586477;
    const double radius = std::sqrt(-2.0 * std::log1p(-nextUniform(stream)));
    return radius * std::cos(kTwoPi * nextUniform(stream));
}

std::vector<std::size_t> chooseIndices(std::size_t total, std::size_t n, std::uint64_t seed,
                                       std::size_t scanIndex, Draw draw) {
    std::vector<std::size_t> chosen;
    chosen.reserve(std::min(total, n));
    std::mt19937_64 stream = randomStream(seed, scanIndex, draw);
    // Selection sampling: index i is taken with probability (still needed) / (still to
    // come).
    for (std::size_t i = 0; i < total && chosen.size() < n; ++i) {
        if (nextUniform(stream) * static_cast<double>(total - i) <
            static_cast<double>(n - chosen.size()))
            chosen.push_back(i);
    }
    return chosen;
}

Scan selectPoints(const Scan& scan, const std::vector<std::size_t>& indices) {
    Scan selected;
    selected.T_map_sensor = scan.T_map_sensor;
    selected.reserve(indices.size());
    for (const std::size_t i : indices) selected.pushBack(scan.x[i], scan.y[i], scan.z[i]);
    for (const Channel& channel : scan.channels) {
        Channel& target = selected.channels.emplace_back();
        target.name = channel.name;
        target.values.reserve(indices.size());
        for (const std::size_t i : indices) target.values.push_back(channel.values[i]);
    }
    return selected;
}

SplitScan splitPoints(Scan scan, std::size_t scanIndex, const SplitParams& params) {
    SplitScan result;
    std::vector<ClearedRay> clearedRays = std::move(scan.clearedRays);
    if (params.holdoutPoints > 0.0) {
        const auto heldOut =
            chooseIndices(scan.size(), countOf(params.holdoutPoints, scan.size()),
                          params.seed, scanIndex, Draw::holdout);
        result.heldOut = selectPoints(scan, heldOut);
        scan = selectPoints(scan, complement(heldOut, scan.size()));
    }
    if (params.subsample < 1.0)
        scan = selectPoints(
            scan, chooseIndices(scan.size(), countOf(params.subsample, scan.size()),
                                params.seed, scanIndex, Draw::subsample));
    result.mapping = std::move(scan);
    result.mapping.clearedRays = std::move(clearedRays);
    return result;
}

}  // namespace hgmm::evaluation
