#include "hgmm/lattice.h"

#include <algorithm>
#include <cstring>

namespace hgmm {

namespace {

/// 2^exponent, for exponents of normal numbers: std::ldexp is a call.
double powerOfTwo(int exponent) {
    const std::uint64_t bits = std::uint64_t(1023 + std::clamp(exponent, -1022, 1023))
                               << 52U;
    double power = 0;
    std::memcpy(&power, &bits, sizeof(power));
    return power;
}

}  // namespace

LatticeCell LatticeCell::at(const Eigen::Vector3d& p, int octave) {
    const double perCell = powerOfTwo(-octave);
    const auto cell = [perCell](double v) {
        const double place = std::clamp(v * perCell, -1e9, 1e9);
        // std::floor is a call on processors that cannot be taken for granted.
        const auto towardsZero = static_cast<std::int32_t>(place);
        return towardsZero - (place < towardsZero ? 1 : 0);
    };
    return {octave, cell(p.x()), cell(p.y()), cell(p.z())};
}

}  // namespace hgmm
