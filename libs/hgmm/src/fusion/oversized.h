#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/scan.h"
#include "scan/cells.h"

namespace hgmm {

class ComponentIndex;
struct NoveltySplit;

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

/// A component that lost support.
struct SupportDecay {
    std::uint32_t component;
    float support;  ///< what is left [count], > 0
};

/// Supports at or below this are none [count]: downweighting leaves at least so much.
constexpr float kNoSupport = 1e-6F;

/// What is left of oversized components when those that learn in their place take over. An
/// oversized component loses, for each sample that it is too thick for, the support that
/// the sample would have given it: the sample's support times the component's
/// responsibility (3.8) among the oversized ones and those that explain the sample. Returns
/// the components that lose, rising.
/// @param index of the mixture's components before the samples changed them
std::vector<SupportDecay> downweightOversized(const Mixture<3>& mixture,
                                              const ComponentIndex& index,
                                              const Mixture<3>& samples,
                                              const NoveltySplit& split);

/// Of the novel samples, those that oversized components could not explain, by their place
/// in split.novel, rising.
std::vector<std::uint32_t> relearned(const NoveltySplit& split);

/// Which components of a first guess are split.
struct SplitPolicy {
    ThicknessLimit limit;
    std::vector<std::uint32_t> relearned;  ///< samples, rising
    double minSupport = 0.0;               ///< [count] no part gets less
};

/// Splits, across the surface, components of doubled cells with relearned samples while
/// they are thicker than the limit. Few hits in a large cell, of the leaves of a bush or of
/// the edge of a thing with what is behind, make a component that explains none of them
/// when they are seen again.
void splitOversized(const Mixture<3>& samples, const SplitPolicy& policy,
                    CellMoments& guess);

}  // namespace hgmm
