#include "hgmm/lattice.h"

#include <algorithm>
#include <cmath>

namespace hgmm {

LatticeCell LatticeCell::at(const Eigen::Vector3d& p, int octave) {
    const double perCell = std::ldexp(1.0, -octave);
    const auto cell = [perCell](double v) {
        return static_cast<std::int32_t>(std::clamp(std::floor(v * perCell), -1e9, 1e9));
    };
    return {octave, cell(p.x()), cell(p.y()), cell(p.z())};
}

}  // namespace hgmm
