#include "hgmm/evaluation/memory.h"

namespace hgmm::evaluation {

Memory memoryOf(const Map& map) {
    return {map.save().size(), map.liveBytes()};
}

std::size_t parameterBytes(const Mixture<3>& mixture) {
    constexpr std::size_t floatsPerComponent = 1 + 3 + Mixture<3>::packed;
    return mixture.size() * floatsPerComponent * sizeof(float);
}

}  // namespace hgmm::evaluation
