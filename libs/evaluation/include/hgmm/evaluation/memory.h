#pragma once
#include <cstddef>

#include "hgmm/map.h"

namespace hgmm::evaluation {

/// Size of a map (protocol, step 5).
struct Memory {
    std::size_t serialized_bytes = 0;  ///< saved, before compression
    std::size_t live_bytes = 0;        ///< heap held, index and levels included
};

Memory memoryOf(const Map& map);

/// Bytes of a level's parameters: the floats that describe it, without any index.
std::size_t parameterBytes(const Mixture<3>& mixture);

}  // namespace hgmm::evaluation
