#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "hgmm/likelihood.h"
#include "hgmm/slam/closure.h"

namespace hgmm::slam {

/// How submaps are found again in a map of an earlier session, nothing known but about
/// which way is up.
struct EarlierMapParams {
    int maxPositions = 4000;  ///< of the sensor that are rated [count], in [1, 1e6]
    int headings = 24;        ///< of each position [count], in [1, 360]
    int aligned = 16;         ///< likeliest places that are aligned [count], in [1, 1e4]
    /// Share of a submap's surfaces that the map must have where it is looked for
    /// everywhere [1], in (0, 1].
    double minOverlap = 0.5;
    /// Submaps that must be found where they lie to each other as in this session; two
    /// where there are no more [count], >= 2.
    int minFound = 3;
    int maxSearched = 24;  ///< submaps, evenly spread, that are looked for [count], >= 1

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// A map of an earlier session, in which submaps of another one are found again. It does
/// not change. Thread-safe; nothing depends on the number of threads.
class EarlierMap {
 public:
    /// Throws std::invalid_argument for params out of range, or a null or empty map.
    explicit EarlierMap(std::shared_ptr<const Map> map,
                        const EarlierMapParams& params = {});

    /// Where a submap may lie, nothing known: the sensor is tried where rays passed, in all
    /// headings about the vertical, which floors and ceilings tell where they are seen, and
    /// the likeliest places are verified (verifiedPose). More than one if the map repeats
    /// itself.
    std::vector<UncertainPose> placesOf(const FinishedSubmap& submap,
                                        const ClosureParams& closure) const;

    /// The same where it is about known: nothing if the map has too little there, or
    /// something else.
    std::optional<UncertainPose> placeNear(const FinishedSubmap& submap,
                                           const UncertainPose& T_map_submap,
                                           const ClosureParams& closure) const;

    const Map& map() const { return *map_; }
    const EarlierMapParams& params() const { return params_; }

 private:
    double headingStep_rad() const;
    std::vector<Pose> likeliestPlaces(const FinishedSubmap& submap) const;

    EarlierMapParams params_;
    std::shared_ptr<const Map> map_;
    std::vector<Eigen::Vector3d> positions_map_;  // in free space
    double spacing_m_ = 0.0;                      // of these
    SurfaceLikelihood likelihood_;
    Eigen::Vector3d vertical_map_;
};

/// How a session lies in an earlier map.
struct FoundSession {
    /// Closures that agree with each other, the largest set: edges from node 0, the earlier
    /// map.
    std::vector<PoseEdge> closures;
    std::size_t searched = 0;  ///< submaps that were looked for [count]
    /// Submaps of the largest set that agrees on another place [count].
    std::size_t elsewhere = 0;
    bool sure = false;  ///< enough were found, and another place is less than half as good
};

/// Looks for submaps of a session until it is sure where they lie, or all were looked for
/// (EarlierMapParams::maxSearched).
/// @param session how the submaps lie to each other: node 0 is the earlier map, about which
/// nothing is known, submap k is node k + 1
FoundSession findSession(const EarlierMap& earlier,
                         const std::vector<std::shared_ptr<const FinishedSubmap>>& submaps,
                         const PoseGraph& session, const ClosureParams& closure,
                         int minScans);

/// The graph of a session, submaps one node further on, behind an earlier map that nothing
/// is known of: node 0, with a first edge that is a mere guess.
PoseGraph behindEarlierMap(const PoseGraph& session);

}  // namespace hgmm::slam
