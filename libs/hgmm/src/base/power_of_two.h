#pragma once
#include <cstdint>
#include <cstring>

#include "hgmm/portable_math.h"

/// Powers of two from the bits of a number, and floors by casts: std::ilogb, std::ldexp and
/// std::floor are calls on processors that cannot be taken for granted, and lattices ask
/// for millions.
namespace hgmm {

using portable::octaveOf;
using portable::powerOfTwo;

/// The same as for doubles.
inline int octaveOf(float v) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &v, sizeof(bits));
    return static_cast<int>(bits >> 23U) - 127;
}

/// 2^octave as a float, without a conversion.
inline float floatPowerOfTwo(int octave) {
    const auto bits = static_cast<std::uint32_t>(octave + 127) << 23U;
    float v = 0;
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

/// floor(v) of a number whose floor is an int32.
template <typename Scalar>
std::int32_t floorToInt(Scalar v) {
    const auto towardsZero = static_cast<std::int32_t>(v);
    return towardsZero - (v < static_cast<Scalar>(towardsZero) ? 1 : 0);
}

}  // namespace hgmm
