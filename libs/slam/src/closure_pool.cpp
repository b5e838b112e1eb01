#include "closure_pool.h"

#include <algorithm>
#include <set>
#include <utility>

namespace hgmm::slam {
namespace {

bool spansGuess(const PoseGraph& graph, const PoseEdge& closure) {
    return isGuess(poseOfAll(graph, closure.from)[closure.to]);
}

}  // namespace

bool ClosurePool::areEnough(const std::vector<std::size_t>& agreeing,
                            const PoseGraph& graph) const {
    if (agreeing.size() < kEnough) return false;
    if (!spansGuess(graph, waiting_[agreeing.front()])) return true;
    std::set<std::size_t> places;
    for (const std::size_t k : agreeing) places.insert(waiting_[k].to);
    return places.size() >= kEnough;
}

std::size_t ClosurePool::enter(std::vector<PoseEdge> closures, PoseGraph& graph) {
    const std::size_t before = graph.edges.size();
    const PoseGraph known = graph;
    for (PoseEdge& closure : closures) {
        if (!spansGuess(known, closure) &&
            disagreementWith(known, closure) < kChiSquareOfSix)
            graph.edges.push_back(std::move(closure));
        else if (!isGuess(closure.T_from_to))
            waiting_.push_back(std::move(closure));
    }
    const std::vector<std::size_t> agreeing = consistentClosures(known, waiting_);
    if (areEnough(agreeing, known)) {
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
