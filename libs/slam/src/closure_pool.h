#pragma once
#include <vector>

#include "hgmm/slam/closure.h"

namespace hgmm::slam {

/// Verified closures on their way into the graph. One that agrees with the graph enters at
/// once; others, and those between parts that only guesses hold together, wait until enough
/// of them agree with each other.
class ClosurePool {
 public:
    explicit ClosurePool(const OptimisationParams& params) : params_(params) {}

    /// Adds to the graph what is believed now, and optimises it.
    /// @return how many closures entered
    std::size_t enter(std::vector<PoseEdge> closures, PoseGraph& graph);

    /// Closures that wait: the state, for saving.
    std::vector<PoseEdge>& waiting() { return waiting_; }

 private:
    static constexpr std::size_t kEnough = 3;  // that agree, against the graph
    static constexpr std::size_t kMost = 60;   // that wait

    /// One place that looks like another agrees with all that is around that one: what
    /// joins parts must be found at several places.
    bool areEnough(const std::vector<std::size_t>& agreeing, const PoseGraph& graph) const;

    OptimisationParams params_;
    std::vector<PoseEdge> waiting_;
};

}  // namespace hgmm::slam
