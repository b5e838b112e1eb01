#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hgmm/map.h"
#include "hgmm/scan.h"
#include "registration/surface_alignment.h"

namespace hgmm {

/// Where a sensor may be, in the frame of a mixture of surfaces.
struct PlaceCandidate {
    Pose T_local_sensor;
    double score = 0.0;  ///< mean log-likelihood of the samples [nat]
};

/// How positions and headings are tried.
struct PlaceSearch {
    /// About as far as candidates are apart [m]: width of the likelihood's kernel.
    double kernelWidth_m = 0.5;
    int headings = 24;          ///< of each position [count]
    std::size_t mostKept = 40;  ///< best candidates [count]
    std::size_t samples = 80;   ///< that rate a candidate [count]
    Eigen::Matrix3d R_local = Eigen::Matrix3d::Identity();  ///< heading 0
};

/// Each position in its best heading about the map's z axis: how likely few samples of the
/// scan are there. The best, likeliest first. Does not depend on the number of threads.
std::vector<PlaceCandidate> likeliestPlaces(const Map& map, const ScanSamples& scan,
                                            const std::vector<Eigen::Vector3d>& positions,
                                            const PlaceSearch& search);

/// Whether two poses are nearer to each other than candidates are apart.
bool areOnePlace(const Pose& a, const Pose& b);

}  // namespace hgmm
