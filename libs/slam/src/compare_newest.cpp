#include "compare_newest.h"

namespace hgmm::slam {

bool endsEarly(const FinishedSubmap& finished, const SubmapParams& params) {
    return static_cast<int>(finished.submap.T_submap_robot.size()) < params.minScans;
}

Compared compareNewest(const std::vector<SharedSubmap>& submaps, const PoseGraph& graph,
                       const SlamParams& params) {
    const std::size_t newest = submaps.size() - 1;
    Compared result;
    if (endsEarly(*submaps[newest], params.submap)) return result;
    for (const Candidate& c : candidatesFor(submaps, graph, newest, params.closure)) {
        if (endsEarly(*submaps[c.target], params.submap)) continue;
        const auto pose = verifiedPose(*submaps[c.target], *submaps[newest],
                                       c.T_target_source, params.closure);
        if (pose)
            result.closures.push_back({c.target, newest, *pose, PoseEdge::Kind::closure});
        else if (contradicts(*submaps[c.target], *submaps[newest], c.T_target_source))
            result.contradictsGraph = true;
    }
    if (!result.closures.empty()) result.contradictsGraph = false;
    return result;
}

}  // namespace hgmm::slam
