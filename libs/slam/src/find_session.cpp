#include <algorithm>
#include <set>
#include <utility>

#include "hgmm/slam/earlier_map.h"

namespace hgmm::slam {
namespace {

using SharedSubmaps = std::vector<std::shared_ptr<const FinishedSubmap>>;

/// How far off a first edge may be of which nothing is known [m], [rad].
constexpr double kUnknown_m = 1e4, kUnknown_rad = 3.0;
/// Sets of closures that lay the session nearer to each other than this are one place.
constexpr double kOneAnswer_m = 2.0, kOneAnswer_rad = 0.35;
/// A single submap may fit another building by chance.
constexpr std::size_t kFewest = 2;
/// More than so many need not be looked for, where they agree.
constexpr int kPlenty = 4;

/// At most so many of some indices, evenly spread.
std::vector<std::size_t> spread(const std::vector<std::size_t>& all, std::size_t most) {
    const std::size_t count = std::min(all.size(), most);
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < count; ++k) some.push_back(all[k * all.size() / count]);
    return some;
}

/// Where the earlier map sees node `node`, if a closure is right.
Pose placedBy(const PoseEdge& closure, const PoseGraph& session, std::size_t node) {
    return closure.T_from_to.T_a_b * session.T_world_node[closure.to].inverse() *
           session.T_world_node[node];
}

/// The closures that say something else than all of some others.
std::vector<PoseEdge> elsewhere(const std::vector<PoseEdge>& all,
                                const std::vector<PoseEdge>& believed,
                                const PoseGraph& session) {
    std::vector<PoseEdge> others;
    for (const PoseEdge& closure : all) {
        const bool same =
            std::any_of(believed.begin(), believed.end(), [&](const PoseEdge& b) {
                const Vector6d off =
                    errorOf(closure.T_from_to.T_a_b, placedBy(b, session, closure.to));
                return off.tail<3>().norm() < kOneAnswer_m &&
                       off.head<3>().norm() < kOneAnswer_rad;
            });
        if (!same) others.push_back(closure);
    }
    return others;
}

std::vector<PoseEdge> consistentOf(const PoseGraph& session,
                                   const std::vector<PoseEdge>& closures) {
    std::vector<PoseEdge> agreeing;
    for (const std::size_t k : consistentClosures(session, closures))
        agreeing.push_back(closures[k]);
    return agreeing;
}

}  // namespace

PoseGraph behindEarlierMap(const PoseGraph& session) {
    PoseGraph graph;
    graph.T_world_node.push_back({});
    graph.T_world_node.insert(graph.T_world_node.end(), session.T_world_node.begin(),
                              session.T_world_node.end());
    UncertainPose unknown{session.T_world_node.at(0), Matrix6d::Zero()};
    unknown.covariance.topLeftCorner<3, 3>().diagonal().setConstant(kUnknown_rad *
                                                                    kUnknown_rad);
    unknown.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(kUnknown_m *
                                                                        kUnknown_m);
    graph.edges.push_back({0, 1, unknown, PoseEdge::Kind::odometry});
    for (PoseEdge edge : session.edges) {
        ++edge.from;
        ++edge.to;
        graph.edges.push_back(std::move(edge));
    }
    return graph;
}

FoundSession findSession(const EarlierMap& earlier, const SharedSubmaps& submaps,
                         const PoseGraph& session, const ClosureParams& closure,
                         int minScans) {
    std::vector<std::size_t> usable;
    for (std::size_t k = 0; k < submaps.size(); ++k)
        if (static_cast<int>(submaps[k]->submap.T_submap_robot.size()) >= minScans)
            usable.push_back(k);
    const std::vector<std::size_t> searched =
        spread(usable, static_cast<std::size_t>(earlier.params().maxSearched));
    const std::size_t needed = std::clamp(
        searched.size(), kFewest, static_cast<std::size_t>(earlier.params().minFound));
    FoundSession found;
    std::vector<PoseEdge> all;
    for (const std::size_t k : searched) {
        for (const UncertainPose& T_map_submap : earlier.placesOf(*submaps[k], closure))
            all.push_back({0, k + 1, T_map_submap, PoseEdge::Kind::closure});
        ++found.searched;
        found.closures = consistentOf(session, all);
        found.elsewhere =
            consistentOf(session, elsewhere(all, found.closures, session)).size();
        found.sure =
            found.closures.size() >= needed && found.closures.size() > 2 * found.elsewhere;
        if (found.sure && static_cast<int>(found.closures.size()) >= kPlenty) break;
    }
    return found;
}

}  // namespace hgmm::slam
