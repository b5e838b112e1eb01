#include "drift.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace hgmm::slam {

UncertainPose withDrift(const UncertainPose& motion, const DriftParams& drift) {
    const double way_m = motion.T_a_b.t.norm();
    const double turn_rad = rotationVectorOf(motion.T_a_b.R).norm();
    UncertainPose drifting = motion;
    drifting.covariance.topLeftCorner<3, 3>().diagonal().array() +=
        1e-8 + drift.turnPerMetre_rad * drift.turnPerMetre_rad * way_m +
        std::pow(drift.turnPerTurn * turn_rad, 2);
    drifting.covariance.bottomRightCorner<3, 3>().diagonal().array() +=
        1e-6 + drift.shiftPerMetre * drift.shiftPerMetre * way_m;
    return drifting;
}

void DriftParams::validate() const {
    for (const auto& [name, value] : {std::pair{"shiftPerMetre", shiftPerMetre},
                                      std::pair{"turnPerMetre_rad", turnPerMetre_rad},
                                      std::pair{"turnPerTurn", turnPerTurn}})
        if (!(value > 0))
            throw std::invalid_argument(std::string(name) + ": must be positive");
}

}  // namespace hgmm::slam
