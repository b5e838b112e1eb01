#pragma once
#include <cstddef>
#include <vector>

namespace hgmm {

/// Room to make where there is none for n values: an eighth more. What a map keeps for long
/// grows often and little, where std::vector would take twice as much.
inline std::size_t roomFor(std::size_t n) {
    return n + n / 8 + 4;
}

/// Resizes to n values, with such room.
template <typename T>
void growTo(std::vector<T>& values, std::size_t n) {
    if (n > values.capacity()) values.reserve(roomFor(n));
    values.resize(n);
}

}  // namespace hgmm
