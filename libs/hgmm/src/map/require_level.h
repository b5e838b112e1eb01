#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>

namespace hgmm {

/// Throws std::out_of_range unless level < count.
inline void requireLevel(std::size_t level, std::size_t count) {
    if (level >= count)
        throw std::out_of_range("Map: no level " + std::to_string(level) + ", only 0 to " +
                                std::to_string(count - 1));
}

}  // namespace hgmm
