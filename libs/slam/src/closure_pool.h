#pragma once
#include <vector>

#include "hgmm/slam/closure.h"

namespace hgmm::slam {

/// Verified closures on their way into the graph. One that agrees with the graph enters at
/// once; others wait until enough of them agree with each other.
class ClosurePool {
 public:
    explicit ClosurePool(const OptimisationParams& params) : params_(params) {}

    /// Adds to the graph what is believed now, and optimises it.
    /// @return how many closures entered
    std::size_t enter(std::vector<PoseEdge> closures, PoseGraph& graph);

 private:
    static constexpr std::size_t kEnough = 3;  // that agree, against the graph
    static constexpr std::size_t kMost = 60;   // that wait

    OptimisationParams params_;
    std::vector<PoseEdge> waiting_;
};

}  // namespace hgmm::slam
