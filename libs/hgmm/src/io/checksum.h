#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hgmm {

/// 64-bit checksum, eight bytes at a time: copies inside a particle filter go through here.
inline std::uint64_t checksum(const std::uint8_t* data, std::size_t size) {
    std::uint64_t h = 0xCBF29CE484222325ULL ^ size;
    const auto mix = [&h](std::uint64_t word) {
        h = (h ^ word) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 32U;
    };
    for (; size >= 8; data += 8, size -= 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, data, 8);
        mix(word);
    }
    std::uint64_t tail = 0;
    std::memcpy(&tail, data, size);
    mix(tail);
    return h;
}

}  // namespace hgmm
