#include "hgmm/evaluation/memory.h"

namespace hgmm::evaluation {

Memory memoryOf(const Map& map) {
    return {map.save().size(), map.liveBytes()};
}

std::size_t levelBytes(const Map& map, std::size_t level) {
    return parameterBytes(map.mixture(level)) + parameterBytes(map.freeMixture(level));
}

}  // namespace hgmm::evaluation
