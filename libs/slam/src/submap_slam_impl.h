#pragma once
#include <future>
#include <memory>
#include <vector>

#include "closure_pool.h"
#include "compare_newest.h"
#include "hgmm/slam/submap_slam.h"

namespace hgmm::slam {

struct SubmapSlam::Impl {
    Impl(const MapParams& map, const SlamParams& slam)
        : mapParams(map), params(slam), pool(slam.optimisation), current(map) {}

    void begin(const Pose& T_world_robot);
    /// Throws as add does.
    void require(const UncertainPose& T_previous_robot) const;
    /// Whether the submap at hand is as large as it gets.
    bool isComplete() const;
    /// Lets closures that were looked for behind enter, and looks for those of the submap
    /// at hand, which is finished.
    void complete();
    /// Looks for closures of the newest finished submap, behind.
    void beginSearch();
    /// Finishes the submap at hand and begins the next one where the robot is.
    void next();
    void move(const UncertainPose& motion);
    void enterClosures();
    bool isFinished() const {
        return started && submaps.size() + firstNode() == graph.T_world_node.size();
    }

    /// Of the submaps: behind an earlier map.
    std::size_t firstNode() const { return earlier ? 1 : 0; }
    const Pose& T_world_submap(std::size_t k) const {
        return graph.T_world_node[k + firstNode()];
    }
    std::size_t submapCount() const { return graph.T_world_node.size() - firstNode(); }

    /// Lets submaps that show the same as the earlier map become closures. From one that is
    /// found onwards to both sides, for the graph knows next where neighbours are.
    void closeWithEarlier(const EarlierMap& map, const std::vector<PoseEdge>& found);

    /// All but finished submaps (StateWriter, StateReader).
    template <typename Archive>
    void archive(Archive& a);

    Pose robot() const { return graph.T_world_node.back() * T_submap_robot.T_a_b; }

    /// Submap k, finished or at hand.
    const Submap& submap(std::size_t k) const {
        return k < submaps.size() ? submaps[k]->submap : current;
    }

    MapParams mapParams;
    SlamParams params;
    PoseGraph graph;
    ClosurePool pool;
    std::vector<SharedSubmap> submaps;
    std::shared_ptr<const Map> earlier;  // that the session was found in
    std::future<Compared> search;
    std::size_t closures = 0;

    Submap current;
    UncertainPose T_submap_robot;  // of the robot in the submap at hand
    double range_m = 0.0;          // median of scans, smoothed
    bool started = false;
};

}  // namespace hgmm::slam
