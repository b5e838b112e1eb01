#pragma once
#include <cstdint>
#include <cstring>

/// Powers of two from the bits of a number, and floors by casts: std::ilogb, std::ldexp and
/// std::floor are calls on processors that cannot be taken for granted, and lattices ask
/// for millions.
namespace hgmm {

/// floor(log2(v)) of a normal positive number.
inline int octaveOf(double v) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof(bits));
    return static_cast<int>(bits >> 52U) - 1023;
}
inline int octaveOf(float v) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &v, sizeof(bits));
    return static_cast<int>(bits >> 23U) - 127;
}

/// 2^octave, for octaves of normal numbers.
inline double powerOfTwo(int octave) {
    const auto bits = static_cast<std::uint64_t>(octave + 1023) << 52U;
    double v = 0;
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}
/// The same as a float, without a conversion.
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
