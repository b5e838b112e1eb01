#pragma once
#include <Eigen/Core>
#include <vector>

#include "hgmm/mixture.h"

namespace hgmm::slam {

/// What a mixture looks like about a point, whichever way the robot was heading: for places
/// that the graph's uncertainty does not tell apart.
///
/// After the histograms of surface shapes by Magnusson, Andreasson, Nuechter and Lilienthal
/// (2009), which need components only, no points: bins of the distance from the point, and
/// within these of the shape (line, plane by its slant, blob). There, dominant planes are
/// turned on each other first; here the third part of the bins is the spectrum of the
/// headings of upright planes, which does not change with yaw. All weigh by the square root
/// of a component's area, so that neither how often nor how finely a surface was cut
/// counts.
struct Appearance {
    Appearance() = default;
    Appearance(const Mixture<3>& mixture, const Eigen::Vector3d& centre);

    /// Of the distributions, in [0, 1]: 1 for the same.
    double similarity(const Appearance& other) const;

    std::vector<double> bins;  ///< sum 1, or empty
};

}  // namespace hgmm::slam
