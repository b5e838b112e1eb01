#pragma once
#include <cmath>
#include <initializer_list>
#include <limits>

#include "base/power_of_two.h"

/// Functions whose bits are the same on every processor, for all that maps depend on. The C
/// library's take other code where a processor has fused multiply-add.
namespace hgmm::portable {

inline constexpr double kLog2High = 0x1.62e42feep-1;  ///< log 2 by 32 bits, and the rest
inline constexpr double kLog2Low = 0x1.a39ef35793c76p-33;

/// e^x within 2 ulp; 0 below -708, infinity above 709.
inline double exp(double x) {
    if (!(x <= 709.0)) return x + std::numeric_limits<double>::infinity();
    if (x < -708.0) return 0.0;
    const double k = std::floor(x * 1.4426950408889634 + 0.5);
    const double r = (x - k * kLog2High) - k * kLog2Low;  // |r| <= log(2) / 2
    // Taylor's series, whose rest is below 1e-17.
    double sum = 1.0 / 6227020800.0;
    for (const double c : {1.0 / 479001600.0, 1.0 / 39916800.0, 1.0 / 3628800.0,
                           1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0,
                           1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0})
        sum = sum * r + c;
    return (1.0 + sum * r) * powerOfTwo(static_cast<int>(k));
}

/// log x, within 2 ulp; -infinity at 0, not a number below.
inline double log(double x) {
    if (!(x > 0.0))
        return x == 0.0 ? -std::numeric_limits<double>::infinity()
                        : std::numeric_limits<double>::quiet_NaN();
    if (x == std::numeric_limits<double>::infinity()) return x;
    int shift = 0;
    if (x < std::numeric_limits<double>::min()) {
        x *= 0x1p54;
        shift = -54;
    }
    int octave = octaveOf(x);
    double m = x * powerOfTwo(-octave);  // in [1, 2)
    if (m > 1.4142135623730951) {
        m *= 0.5;
        ++octave;
    }
    // 2 atanh(s), |s| <= 0.172.
    const double s = (m - 1.0) / (m + 1.0), s2 = s * s;
    double sum = 1.0 / 23.0;
    for (const double c : {1.0 / 21.0, 1.0 / 19.0, 1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0,
                           1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0})
        sum = sum * s2 + c;
    const double e = octave + shift;
    return e * kLog2High + (e * kLog2Low + (2.0 * s + 2.0 * s * s2 * sum));
}

}  // namespace hgmm::portable
