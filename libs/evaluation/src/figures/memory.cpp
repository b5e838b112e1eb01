#include "hgmm/evaluation/memory.h"

namespace hgmm::evaluation {

Memory memoryOf(const Map& map) {
    // What queries need is made when they first ask.
    map.occupancy(map.origin());
    return {map.save().size(), map.liveBytes()};
}

std::size_t levelBytes(const Map& map, std::size_t level) {
    return kSurfaceBytes * map.mixture(level).size() +
           kFreeBytes * map.freeMixture(level).size() + map.coverageBytes(level);
}

}  // namespace hgmm::evaluation
