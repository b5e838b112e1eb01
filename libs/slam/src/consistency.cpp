#include <algorithm>
#include <map>

#include "hgmm/slam/closure.h"

namespace hgmm::slam {
namespace {

/// How nodes see each other, computed once for each node.
class GraphViews {
 public:
    explicit GraphViews(const PoseGraph& graph) : graph_(graph) {}

    const UncertainPose& of(std::size_t from, std::size_t to) {
        auto found = views_.find(from);
        if (found == views_.end())
            found = views_.emplace(from, poseOfAll(graph_, from)).first;
        return found->second[to];
    }

 private:
    const PoseGraph& graph_;
    std::map<std::size_t, std::vector<UncertainPose>> views_;
};

/// Whether the loop a.from -> a.to -> b.to -> b.from -> a.from closes.
bool consistent(const PoseEdge& a, const PoseEdge& b, GraphViews& views) {
    const UncertainPose loop = a.T_from_to * views.of(a.to, b.to) * b.T_from_to.inverse() *
                               views.of(b.from, a.from);
    return squaredMahalanobis(errorOf(loop.T_a_b, Pose{}), loop.covariance) <
           kChiSquareOfSix;
}

}  // namespace

double disagreementWith(const PoseGraph& graph, const PoseEdge& closure) {
    const UncertainPose known = poseOfAll(graph, closure.from)[closure.to];
    return squaredMahalanobis(errorOf(closure.T_from_to.T_a_b, known.T_a_b),
                              known.covariance + closure.T_from_to.covariance);
}

std::vector<std::size_t> consistentClosures(const PoseGraph& graph,
                                            const std::vector<PoseEdge>& closures) {
    const std::size_t n = closures.size();
    GraphViews views(graph);
    std::vector<std::vector<bool>> agree(n, std::vector<bool>(n, true));
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = a + 1; b < n; ++b)
            agree[a][b] = agree[b][a] = consistent(closures[a], closures[b], views);
    std::vector<std::size_t> best;
    for (std::size_t seed = 0; seed < n; ++seed) {
        std::vector<std::size_t> clique{seed};
        std::vector<std::size_t> others;
        for (std::size_t k = 0; k < n; ++k)
            if (k != seed && agree[seed][k]) others.push_back(k);
        const auto friends = [&](std::size_t k) {
            return std::count_if(others.begin(), others.end(),
                                 [&](std::size_t o) { return agree[k][o]; });
        };
        std::stable_sort(others.begin(), others.end(), [&](std::size_t x, std::size_t y) {
            return friends(x) > friends(y);
        });
        for (const std::size_t k : others)
            if (std::all_of(clique.begin(), clique.end(),
                            [&](std::size_t c) { return agree[c][k]; }))
                clique.push_back(k);
        if (clique.size() > best.size()) best = clique;
    }
    std::sort(best.begin(), best.end());
    return best;
}

}  // namespace hgmm::slam
