#pragma once
#include <memory>
#include <vector>

#include "hgmm/slam/submap_slam.h"

namespace hgmm::slam {

using SharedSubmap = std::shared_ptr<const FinishedSubmap>;

/// Whether a submap holds too little to be aligned well.
bool endsEarly(const FinishedSubmap& finished, const SubmapParams& params);

/// What comparing the newest of some submaps with older ones has brought.
struct Compared {
    std::vector<PoseEdge> closures;  ///< verified
    /// It lies on an older one, as the graph has it, that cannot be the same place.
    bool contradictsGraph = false;
};

/// A function of its arguments, for any number of threads.
Compared compareNewest(const std::vector<SharedSubmap>& submaps, const PoseGraph& graph,
                       const SlamParams& params);

}  // namespace hgmm::slam
