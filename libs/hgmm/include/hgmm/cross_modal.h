#pragma once
#include <Eigen/Core>
#include <string>

namespace hgmm {

/// A modality that was observed: the prior of a cross-modal inference (thesis 5.2).
struct ModalityValue {
    std::string name;
    double value = 0.0;  ///< [unit of the channel]
};

/// A modality inferred from others. Where no place with such values was found, mean and
/// variance are the target's own regression (5.6) at the point that was asked for.
struct CrossModalEstimate {
    double mean = 0.0;      ///< thesis eq. (5.13) [unit of the channel]
    double variance = 0.0;  ///< eq. (5.7) at the place [unit squared], >= 0
    bool known = false;     ///< whether a place with such values was found
    Eigen::Vector3d place_map = Eigen::Vector3d::Zero();  ///< x_p of eq. (5.12), (5.14) [m]
    double likelihood = 0.0;  ///< of the values there, eq. (5.14) [sum of 1/unit]
};

}  // namespace hgmm
