#pragma once
#include <cstddef>
#include <cstdint>

#include "hgmm/evaluation/points.h"
#include "hgmm/mixture.h"

namespace hgmm::evaluation {

/// How well a surface model and measured points cover each other (protocol, step 4).
struct Reconstruction {
    double accuracy_m =
        0.0;  ///< mean distance of a model point to the nearest measured one
    double completeness_m =
        0.0;                 ///< mean distance of a measured point to the nearest model one
    double chamfer_m = 0.0;  ///< mean of the two
    double precision = 0.0;  ///< share of model points within the threshold, [0, 1]
    double recall = 0.0;     ///< share of measured points within the threshold, [0, 1]
    double f1 = 0.0;         ///< harmonic mean of precision and recall, [0, 1]
};

constexpr double kF1Threshold_m = 0.05;

/// Nearest-neighbour distances both ways. Both sets in one frame. Throws
/// std::invalid_argument if either is empty.
Reconstruction compareSurfaces(const Points& model, const Points& measured,
                               double threshold_m = kF1Threshold_m);

/// Distance [m] from each query to the nearest of `targets`, which must not be empty.
std::vector<double> nearestDistances(const Points& queries, const Points& targets);

/// Draws n points from a mixture whose local frame has its origin at `origin_map`.
Points sampleSurface(const Mixture<3>& mixture, const Eigen::Vector3d& origin_map,
                     std::size_t n, std::uint64_t seed);

}  // namespace hgmm::evaluation
