#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/mixture.h"
#include "hgmm/params.h"

namespace hgmm {

/// Sensors, and frames of maps, lie within this distance of the origin of the map frame
/// along each axis [m]: in Earth-centred frames, too.
constexpr double kMaxPosition_m = 1e8;

/// Rigid transform; p_a = R p_b + t for a pose named T_a_b.
struct Pose {
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< rotation, orthonormal
    Eigen::Vector3d t = Eigen::Vector3d::Zero();      ///< translation [m]

    Pose operator*(const Pose& o) const { return {R * o.R, R * o.t + t}; }
    Pose inverse() const { return {R.transpose(), -(R.transpose() * t)}; }
};

/// One further quantity measured at each point of a scan.
struct Channel {
    std::string name;           ///< "r", "g", "b" or "intensity", or a user's own name
    std::vector<float> values;  ///< one per point; colours and intensity in [0, 1]
};

/// A ray that saw nothing up to some range: it clears space from the sensor on and marks
/// nothing at its end.
struct ClearedRay {
    Eigen::Vector3f direction;  ///< in the sensor frame, unit to 1e-3
    float length_m = 0;         ///< how far it clears [m], >= 0
};

/// What one sensor saw from one place. Rays start at the origin of the sensor frame.
struct Scan {
    std::vector<float> x, y, z;     ///< points in the sensor frame [m]
    std::vector<Channel> channels;  ///< may be empty
    Pose T_map_sensor;              ///< pose of the sensor in the map frame
    /// Rays without a point: of no return, or of one too far to be trusted.
    std::vector<ClearedRay> clearedRays;

    std::size_t size() const { return x.size(); }
    HGMM_EXPORT void reserve(std::size_t n);
    HGMM_EXPORT void pushBack(float px, float py, float pz);
    /// Throws std::invalid_argument if x, y, z or a channel differ in length, the pose is
    /// not finite, farther than kMaxPosition_m or its rotation not orthonormal to 1e-4, or
    /// a cleared ray's direction is not unit to 1e-3 or its length negative or not finite.
    /// Points need not be finite: the filter counts and drops those that are not.
    HGMM_EXPORT void validate() const;
};

/// A scan makes at most so many samples, for they are what an insertion takes time and
/// memory for. If its points fill more leaves, all leaves double their edge until they do
/// not.
constexpr std::size_t kMaxSamples = std::size_t{1} << 18U;

/// What the filter kept and dropped [points].
struct FilterCounts {
    std::size_t used = 0;
    std::size_t notFinite = 0;
    std::size_t tooNear = 0;  ///< nearer than minRange_m: dropped
    /// Farther than maxRange_m: no hits, but samplesOf makes cleared rays of them.
    std::size_t cut = 0;
    int doublings = 0;  ///< of the leaves' edges, for the sake of kMaxSamples
};

/// Reduces a scan to samples in the sensor frame: one for each occupied leaf
/// (FilterParams). Support = points in the leaf, mean = their centroid, covariance = their
/// scatter plus the sensor's noise variance (so a leaf with one point is a Gaussian of the
/// size of the measurement's uncertainty, and later stages need no noise model of their
/// own). The order is that of each leaf's first point, whatever the number of threads.
HGMM_EXPORT Mixture<3> filterScan(const Scan& scan, const FilterParams& params,
                                  FilterCounts* counts = nullptr);

/// The same samples in another frame.
HGMM_EXPORT Mixture<3> transformed(const Mixture<3>& mixture, const Pose& T_target_source);

/// A scan's own mixture, in the sensor's frame: what Map::insert makes of a scan before it
/// looks at the map. It is the same wherever the scan was taken from, so that particles,
/// which put one scan into many maps, share it.
struct ScanSamples {
    /// After the filter (filterScan), with rings of sparse lidars joined
    /// (interpolateRings).
    Mixture<3> samples_sensor;
    FilterCounts points;  ///< that the filter kept and dropped
    /// Rays that clear space and mark nothing at their end: those of the points beyond
    /// maxRange_m and Scan::clearedRays, both cut there. Of rays that end in one leaf of
    /// the filter only the first is here; the order is that of points, then of rays.
    std::vector<ClearedRay> clearedRays_sensor;
    /// Unit normal of the plane that holds all rays, as those of a planar laser; zero where
    /// there is none. Without it, the ends of a planar laser's walls pass for surfaces
    /// across its plane.
    Eigen::Vector3d normalOfRays_sensor = Eigen::Vector3d::Zero();
    /// Angle between a ray and the next, where rays are even [rad]; 0 without rays.
    double raySpacing_rad = 0.0;
};

/// Uses params.filter and params.cells. Throws std::invalid_argument for a malformed scan
/// (Scan::validate) and for fields out of range.
HGMM_EXPORT ScanSamples samplesOf(const Scan& scan, const MapParams& params);

}  // namespace hgmm
