#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "io/checksum.h"

namespace hgmm::fuzz {

/// Gives the saved map that begins at `begin`, and goes on to the end, the size and the
/// checksum that it should have, so that what is inside is read.
inline void repairHead(std::vector<std::uint8_t>& bytes, std::size_t begin) {
    constexpr std::size_t kHead = 24;
    if (bytes.size() < begin + kHead) return;
    std::uint8_t* const map = bytes.data() + begin;
    const std::uint64_t size = bytes.size() - begin;
    const std::uint64_t sum = checksum(map + kHead, size - kHead);
    std::memcpy(map, "HGMM", 4);
    std::memcpy(map + 8, &size, sizeof(size));
    std::memcpy(map + 16, &sum, sizeof(sum));
}

}  // namespace hgmm::fuzz
