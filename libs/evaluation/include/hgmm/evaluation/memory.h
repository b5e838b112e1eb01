#pragma once
#include <cstddef>
#include <optional>

#include "hgmm/map.h"

namespace hgmm::evaluation {

/// Size of a map (protocol, step 5).
struct Memory {
    std::optional<std::size_t> serialized_bytes;  ///< saved, before compression
    std::size_t live_bytes = 0;                   ///< heap held, index and levels included
};

Memory memoryOf(const Map& map);

/// Bytes of a mixture's parameters: the floats that describe it, without any index.
template <int D>
std::size_t parameterBytes(const Mixture<D>& mixture) {
    constexpr std::size_t floatsPerComponent = 1 + D + Mixture<D>::packed;
    return mixture.size() * floatsPerComponent * sizeof(float);
}

/// Bytes of the mixtures, surface and free space, that answer queries at one level. Throws
/// std::out_of_range for a level that does not exist.
std::size_t levelBytes(const Map& map, std::size_t level);

}  // namespace hgmm::evaluation
