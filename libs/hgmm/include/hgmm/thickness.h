#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hgmm/cells.h"
#include "hgmm/filter.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// Unit normal of the plane that holds all rays of a scan, as those of a planar laser:
/// their root mean square slope to it is below 0.01 and they spread ten times as far in it.
/// Zero where there is none.
/// @param samples_sensor in the sensor's frame
Eigen::Vector3d normalOfRays(const Mixture<3>& samples_sensor);

/// How thick a component may be across a surface that the rays of a scan meet.
///
/// A ray along u meets a component as a surface with the normal n = Sigma^-1 u, across
/// which its variance is u^T n / |n|^2: the smallest one for a plane, however slanted. A
/// planar laser sees a section by the plane of its rays, in which n is taken: for a blob of
/// its hits, which is flat in this plane, the variance is one within it.
///
/// Parameters are referred to and must outlive it.
struct ThicknessLimit {
    /// Standard deviation, besides that of the noise [cell edges at the ray's range,
    /// CellParams::edgeAt], > 0.
    double maxThickness;
    const CellParams& cells;       ///< of the samples' first guess
    const FilterParams& filter;    ///< the sensor's noise
    Eigen::Vector3d sensorOrigin;  ///< of the samples, in their frame
    /// In the frame of the samples; zero where rays do not lie in one plane.
    Eigen::Vector3d normalOfRays = Eigen::Vector3d::Zero();

    /// Variance that is allowed at a range [m^2].
    double maxVarianceAt(double range_m) const;
    /// The normal n that counts, from Sigma^-1 u.
    Eigen::Vector3d inPlaneOfRays(const Eigen::Vector3d& normal) const {
        return normal - normalOfRays * normalOfRays.dot(normal);
    }
};

/// What is to be thin from the first guess on.
struct Thinning {
    ThicknessLimit limit;
    /// Of the samples, those that a component which is too thick could not explain, rising.
    std::vector<std::uint32_t> again;
    double minSupport = 0.0;  ///< [count] nothing is cut into less
};

}  // namespace hgmm
