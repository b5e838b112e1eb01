#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// Which scans and points build the map and which test it (protocol, step 1).
struct SplitParams {
    int every = 0;  ///< K: scan i is a test scan if i % K == K / 2; 0 = none [count]
    double subsample =
        1.0;  ///< fraction of each mapping scan's points that is kept, (0, 1]
    double holdoutPoints =
        0.0;                 ///< fraction of each mapping scan's points held out, [0, 1)
    std::uint64_t seed = 1;  ///< of every random choice

    /// Throws std::invalid_argument naming the field.
    void validate() const;

    /// Whether the whole scan is kept from the map.
    bool isTestScan(std::size_t scanIndex) const;
};

/// What the random numbers of a scan are drawn for: each use has a stream of its own, so
/// that one choice never shifts another.
enum class Draw : std::uint64_t {
    holdout = 1,
    subsample = 2,
    queries = 3,
    reference = 4,
    uniformFree = 5,
    nearFree = 6,
    rangeNoise = 7,
    room = 8,
    modality = 9,
    modalityQueries = 10,
    startPose = 11,
    dust = 12,
    view = 13,
    unseen = 14
};

/// The random numbers of one use in one scan.
std::mt19937_64 randomStream(std::uint64_t seed, std::size_t scanIndex, Draw draw);

/// The next number of a stream, uniform in [0, 1); the same on every platform.
double nextUniform(std::mt19937_64& stream);

/// The next number of a stream, standard normal (Box and Muller); the same on every
/// platform, as std::normal_distribution is not.
double nextNormal(std::mt19937_64& stream);

/// Chooses `n` of `total` indices, rising, each subset equally likely; all of them if
/// n >= total. The same (seed, scanIndex, draw) gives the same choice.
std::vector<std::size_t> chooseIndices(std::size_t total, std::size_t n, std::uint64_t seed,
                                       std::size_t scanIndex, Draw draw);

/// The points of a scan (and their channels) named by `indices`, in that order.
Scan selectPoints(const Scan& scan, const std::vector<std::size_t>& indices);

/// A mapping scan, taken apart.
struct SplitScan {
    Scan mapping;  ///< what the map may see
    Scan heldOut;  ///< test points; empty without holdoutPoints
};

/// Holds out points first, then thins what is left. For mapping scans, which keep their
/// cleared rays.
SplitScan splitPoints(Scan scan, std::size_t scanIndex, const SplitParams& params);

}  // namespace hgmm::evaluation
