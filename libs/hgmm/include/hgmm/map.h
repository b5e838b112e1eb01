#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/collision.h"
#include "hgmm/export.h"
#include "hgmm/known_cells.h"
#include "hgmm/mixture.h"
#include "hgmm/modality.h"
#include "hgmm/occupancy.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"
#include "hgmm/surface_distance.h"
#include "hgmm/view_directions.h"

namespace hgmm {

/// What one scan did to the map.
struct InsertReport {
    FilterCounts points;
    std::size_t samples = 0;              ///< after the filter
    std::size_t novelSamples = 0;         ///< not explained by the map before this scan
    std::size_t componentsUpdated = 0;    ///< that absorbed known samples
    std::size_t componentsAdded = 0;      ///< for novel samples
    std::size_t componentsMissed = 0;     ///< of few hits, that a ray was for and missed
    std::size_t componentsCarved = 0;     ///< that the scan saw through
    std::size_t componentsOversized = 0;  ///< too thick for what the scan saw there
    std::size_t componentsRemoved = 0;    ///< of these three, for want of support
};

/// How Map::save writes components.
enum class Encoding : std::uint8_t {
    exact,   ///< every bit: copies go on as the original would
    compact  ///< less than half the size, errors well below a component's own size
};

/// A buffer that Map::load cannot use: truncated, corrupt, foreign, or of a newer version.
class HGMM_EXPORT FormatError : public std::runtime_error {
 public:
    using std::runtime_error::runtime_error;
};

/// A hierarchy of Gaussian mixtures over what range sensors saw (thesis chapter 3), with
/// the free space that their rays passed (chapter 4), updated scan by scan.
///
/// Components are floats in a local frame whose axes are those of the map and whose origin
/// is fixed, on a lattice of whole metres, by the first scan; poses and points cross this
/// interface in double. Const member functions may be called from several threads at once.
class HGMM_EXPORT Map {
 public:
    /// Throws std::invalid_argument naming the field that is out of range.
    explicit Map(const MapParams& params = {});
    Map(const Map& o);
    Map(Map&& o) noexcept;
    Map& operator=(const Map& o);
    Map& operator=(Map&& o) noexcept;
    ~Map();

    /// A copy for readers on other threads, ready for queries of level 0, so that they
    /// never wait for a writer: it calls this between its changes and hands the result on.
    /// Takes time and memory as a copy of the bytes that liveBytes() counts.
    std::shared_ptr<const Map> snapshot() const;

    /// A map that knows what a map of another kind does, as one of octrees or grids:
    /// surfaces, from the outer faces of occupied cells, seen from the side of the free
    /// cells; coverage, which is exactly the free cells; what is unknown stays so. Throws
    /// std::invalid_argument for malformed cells (KnownCells::validate) or some beyond
    /// kMaxPosition_m, and as the constructor does.
    static Map fromCells(const KnownCells& cells, const MapParams& params = {});
    /// A map of surfaces alone, from points that nobody knows where they were seen from:
    /// nothing is free, and components have no view directions. Points that are not finite
    /// are left out. Throws std::invalid_argument for points that are too far apart or
    /// beyond kMaxPosition_m, and as the constructor does.
    static Map fromPoints(const std::vector<Eigen::Vector3d>& points_map,
                          const MapParams& params = {});

    const MapParams& params() const;
    /// For scans inserted from now on. Throws like the constructor.
    void setParams(const MapParams& params);

    /// Filter -> novelty split -> { known: update | novel: EM, hierarchy, append |
    /// oversized: lose support }, then free space and coverage, then carving of surfaces
    /// that rays passed through and decay of those that they missed; modalities, which are
    /// models of their own, at the same time. Throws std::invalid_argument for a malformed
    /// scan (Scan::validate), leaving the map as it was; a scan without usable points
    /// changes nothing.
    InsertReport insert(const Scan& scan);
    /// The same for a scan whose samples are at hand, samplesOf(scan, params()): many maps
    /// can share them. Modalities learn nothing. Throws std::invalid_argument for a pose
    /// that is not finite, farther than kMaxPosition_m or not rigid.
    InsertReport insert(const ScanSamples& scan, const Pose& T_map_sensor);

    /// Adds what another map knows; this map's parameters stay.
    ///
    /// A surface component joins the one that it resembles most, as seen from the same
    /// side and before the merge, if KL is within params().hierarchy.similarityMax either
    /// way; others are added. Free space and coverage join cell by cell. Nothing is
    /// forgotten: rays are gone, so where one map is free and the other occupied, both
    /// stay.
    ///
    /// @param T_this_other pose of the other map's frame in this one's
    /// Throws std::invalid_argument for a pose that is not finite, farther than
    /// kMaxPosition_m or not rigid, or that would move what the other map knows as far, or
    /// its components beyond kMaxCoordinate_m; nothing is changed then.
    void merge(const Map& other, const Pose& T_this_other = {});

    /// Removes the surface components of the base level whose means lie in a box, its faces
    /// included: for what a user knows to be gone. Free space, coverage and modalities
    /// stay.
    /// @param box_map in the map frame [m]
    /// @return how many were removed
    /// Throws std::invalid_argument for a box that is empty (a corner `min` above `max`) or
    /// not finite; nothing is changed then.
    std::size_t forget(const Eigen::AlignedBox3d& box_map);

    /// The part of this map that answers within a box, with the same parameters and frame.
    ///
    /// Within the box, faces included, occupancy() of level 0 and modality(), where it is
    /// known, are those of the whole map, bit for bit, and logDensity() but for a constant.
    /// distance() is that of the whole map where the surface is not farther than the faces;
    /// grow the box for more. Upper levels are made of what is kept.
    /// @param box_map in the map frame [m]
    /// Throws like forget().
    Map crop(const Eigen::AlignedBox3d& box_map) const;

    bool empty() const;
    void clear();

    /// Origin of the local frame in the map frame [m].
    const Eigen::Vector3d& origin() const;
    /// Number of levels, base included: params().hierarchy.levels.
    std::size_t levelCount() const;
    /// Mixture of a level in the local frame; 0 is the base. Upper levels are brought up to
    /// date here, where the base changed. The reference holds until the next non-const
    /// call. Throws std::out_of_range for a level that does not exist.
    const Mixture<3>& mixture(std::size_t level = 0) const;
    /// View directions of a level's components, in its order. As for mixture().
    const ViewDirections& viewDirections(std::size_t level = 0) const;
    /// Free-space components over (X, W) (thesis 4.2) of a level, in the local frame. As
    /// for mixture().
    const Mixture<4>& freeMixture(std::size_t level = 0) const;
    /// Size of a level's coverage, where rays passed, as it is saved compactly [bytes].
    /// Throws std::out_of_range for a level that does not exist.
    std::size_t coverageBytes(std::size_t level = 0) const;

    /// log p(point) under the base level [nat]. Of components farther than kReachSigmas
    /// only those of the point's cells count: -infinity where there are none. Throws
    /// nothing.
    double logDensity(const Eigen::Vector3d& point_map) const;

    /// Occupied, free or unknown, with the distance to the surface and its variance (thesis
    /// 4.3). A point that is not finite is unknown. Throws std::out_of_range for a level
    /// that does not exist.
    Occupancy occupancy(const Eigen::Vector3d& point_map, std::size_t level = 0) const;
    /// The same for n points, on all threads: answers are those of single queries, bit for
    /// bit.
    void occupancy(const Eigen::Vector3d* points_map, std::size_t n, Occupancy* answers,
                   std::size_t level = 0) const;
    /// Gradient of Occupancy::occupied [1/m]; zero where nothing was seen.
    Eigen::Vector3d occupancyGradient(const Eigen::Vector3d& point_map,
                                      std::size_t level = 0) const;
    /// Follows a ray to the first surface whose P(occ) reaches params.minOccupied (RayHit);
    /// nothing if there is none. `direction_map` need not be of unit length. Throws
    /// std::invalid_argument for a direction that is zero or not finite, or params out of
    /// range.
    std::optional<RayHit> castRay(const Eigen::Vector3d& origin_map,
                                  const Eigen::Vector3d& direction_map,
                                  const RayCastParams& params = {},
                                  std::size_t level = 0) const;

    /// @name Distance
    /// A component's patch is the rectangle across its thinnest axis, centred at its mean,
    /// that reaches kPatchSigmas along each of the other two.
    /// @{

    /// Euclidean distance to the nearest patch of a level, however it is seen. A point that
    /// is not finite has no answer. Throws std::out_of_range for a level that does not
    /// exist and std::invalid_argument for params out of range.
    SurfaceDistance distance(const Eigen::Vector3d& point_map,
                             const DistanceParams& params = {},
                             std::size_t level = 0) const;
    /// The same for n points, on all threads: answers are those of single queries, bit for
    /// bit.
    void distance(const Eigen::Vector3d* points_map, std::size_t n,
                  SurfaceDistance* answers, const DistanceParams& params = {},
                  std::size_t level = 0) const;
    /// The same in the horizontal plane, where patches are line segments: for maps of
    /// planar lasers. Heights do not matter, and the gradient is horizontal.
    SurfaceDistance horizontalDistance(const Eigen::Vector2d& point_map,
                                       const DistanceParams& params = {},
                                       std::size_t level = 0) const;

    /// Whether a body at rest or in motion meets a surface (Collision). Throws
    /// std::invalid_argument for a body whose numbers are not finite or whose radius or
    /// half edges are negative, or params out of range, and std::out_of_range for a level
    /// that does not exist.
    Collision collision(const Capsule& body_map, const CollisionParams& params = {},
                        std::size_t level = 0) const;
    Collision collision(const OrientedBox& body_map, const CollisionParams& params = {},
                        std::size_t level = 0) const;
    /// @}

    /// @name Modalities (thesis chapter 5)
    /// @{

    /// Names of the channels that this map models: params().modalities.
    const std::vector<std::string>& modalities() const;
    /// The model of a modality; null if no scan had it yet or the map does not model it.
    /// Valid until the next non-const call.
    const ModalityMap* modality(const std::string& name) const;
    /// The modality at a point: thesis eq. (5.6) and (5.7). Throws std::invalid_argument
    /// for a name that the map does not model. A point that is not finite is not known.
    ModalityEstimate modality(const std::string& name,
                              const Eigen::Vector3d& point_map) const;
    /// The same for n points, on all threads: answers are those of single queries, bit for
    /// bit.
    void modality(const std::string& name, const Eigen::Vector3d* points_map, std::size_t n,
                  ModalityEstimate* answers) const;
    /// Infers a modality from the values of others (thesis 5.2, CrossModalEstimate), at
    /// a place if it is given. Priors that were never measured do not count. Throws
    /// std::invalid_argument for names that the map does not model, no priors at all, or a
    /// value or point that is not finite.
    CrossModalEstimate infer(
        const std::string& target, const std::vector<ModalityValue>& priors,
        const std::optional<Eigen::Vector3d>& point_map = std::nullopt) const;
    /// @}

    /// Versioned, little-endian, self-describing; parameters included. What is computed
    /// from it (index, upper levels) is left out and built when first needed. A map loaded
    /// from a compact buffer saves to the same buffer again.
    std::vector<std::uint8_t> save(Encoding encoding = Encoding::compact) const;
    /// Throws FormatError.
    static Map load(const std::uint8_t* data, std::size_t size);

    /// Heap held by the map, index and levels included [bytes].
    std::size_t liveBytes() const;

    /// Same parameters, origin, components and views, bit for bit.
    bool operator==(const Map& o) const;
    bool operator!=(const Map& o) const { return !(*this == o); }

 private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace hgmm
