#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hgmm {

/// Numbers in a register of 16 bytes: vectors of GCC and Clang, which unlike Eigen's arrays
/// are put together from scalars without a detour through memory.
typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));
typedef double Double2 __attribute__((vector_size(16)));

/// floor(v) of numbers whose floors are int32.
inline Int4 floorToInt(Float4 v) {
    const auto towardsZero = __builtin_convertvector(v, Int4);
    return towardsZero + (v < __builtin_convertvector(towardsZero, Float4));  // true is -1
}

/// Bit k says whether lane k of a comparison is true (-1, not 0).
inline unsigned bitsOf(Int4 isTrue) {
#ifdef __SSE2__
    return static_cast<unsigned>(__builtin_ia32_movmskps((Float4)isTrue));
#else
    return (isTrue[0] & 1U) | (isTrue[1] & 2U) | (isTrue[2] & 4U) | (isTrue[3] & 8U);
#endif
}

/// The sums of the lanes of each.
inline Float4 sumsOfLanes(Float4 a, Float4 b, Float4 c, Float4 d) {
    const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5) +
                      __builtin_shufflevector(a, b, 2, 6, 3, 7),
                 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5) +
                      __builtin_shufflevector(c, d, 2, 6, 3, 7);
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) +
           __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/// The first `count` of four numbers, zeros behind them.
inline Float4 loadUpTo4(const float* v, std::size_t count) {
    Float4 lanes{};
    if (count >= 4)
        std::memcpy(&lanes, v, sizeof(lanes));
    else
        std::memcpy(&lanes, v, count * sizeof(float));
    return lanes;
}

}  // namespace hgmm
