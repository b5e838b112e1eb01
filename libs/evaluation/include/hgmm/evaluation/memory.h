#pragma once
#include <cstddef>
#include <optional>

#include "hgmm/map.h"

namespace hgmm::evaluation {

/// Size of a map (protocol, step 5).
struct Memory {
    std::optional<std::size_t> serialized_bytes;  ///< saved, before compression
    std::size_t live_bytes = 0;                   ///< heap held, ready for queries
};

/// What maps are compared by: saved, or as held in memory where they cannot be saved
/// [bytes].
inline std::size_t countedBytes(const Memory& memory) {
    return memory.serialized_bytes.value_or(memory.live_bytes);
}

/// Of a map whose base level answers queries.
Memory memoryOf(const Map& map);

/// Bytes of a component, with its view, in a map that is saved compactly (Map::save).
constexpr std::size_t kSurfaceBytes = 20, kFreeBytes = 23;

/// Bytes of the components, surface and free space, and of the coverage that answer queries
/// at one level, as Map::save would write them: what a map of this level alone would take
/// but for its parameters. Throws std::out_of_range for a level that does not exist.
std::size_t levelBytes(const Map& map, std::size_t level);

}  // namespace hgmm::evaluation
