#pragma once
#include <cstdint>

namespace hgmm {

/// Numbers in a register of 16 bytes: vectors of GCC and Clang, which unlike Eigen's arrays
/// are put together from scalars without a detour through memory.
typedef float Four __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));
typedef double Two __attribute__((vector_size(16)));

/// floor(v) of numbers whose floors are int32.
inline FourInts floorToInt(Four v) {
    const auto towardsZero = __builtin_convertvector(v, FourInts);
    return towardsZero + (v < __builtin_convertvector(towardsZero, Four));  // true is -1
}

}  // namespace hgmm
