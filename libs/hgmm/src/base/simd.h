#pragma once
#include <cstdint>

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

}  // namespace hgmm
