#include "closure_pool.h"

#include <algorithm>
#include <utility>

namespace hgmm::slam {

std::size_t ClosurePool::enter(std::vector<PoseEdge> closures, PoseGraph& graph) {
    const std::size_t before = graph.edges.size();
    const PoseGraph known = graph;
    for (PoseEdge& closure : closures) {
        if (disagreementWith(known, closure) < kChiSquareOfSix)
            graph.edges.push_back(std::move(closure));
        else
            waiting_.push_back(std::move(closure));
    }
    const std::vector<std::size_t> agreeing = consistentClosures(known, waiting_);
    if (agreeing.size() >= kEnough) {
        for (auto k = agreeing.rbegin(); k != agreeing.rend(); ++k) {
            graph.edges.push_back(waiting_[*k]);
            waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(*k));
        }
    }
    if (waiting_.size() > kMost) waiting_.erase(waiting_.begin(), waiting_.end() - kMost);
    optimise(graph, before, params_);
    return graph.edges.size() - before;
}

}  // namespace hgmm::slam
