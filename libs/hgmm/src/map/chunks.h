#pragma once
#include <algorithm>
#include <cstddef>

namespace hgmm {

/// Calls answer(begin, end) for the ranges of 256 that n items are cut into, on all
/// threads.
template <typename Answer>
void forEachChunk(std::size_t n, Answer&& answer) {
    constexpr std::size_t size = 256;
#pragma omp parallel for schedule(dynamic)
    for (std::size_t chunk = 0; chunk < (n + size - 1) / size; ++chunk)
        answer(chunk * size, std::min(n, (chunk + 1) * size));
}

}  // namespace hgmm
