#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "hgmm/export.h"
#include "hgmm/mixture.h"
#include "hgmm/params.h"

namespace hgmm {

class ModalityGroup;

/// What a map says about a modality.
struct ModalityEstimate {
    double mean = 0.0;      ///< m(x), thesis eq. (5.6) [unit of the channel]
    double variance = 0.0;  ///< v(x), thesis eq. (5.7) [unit squared], >= 0
    /// Whether anything was measured around x. If not, mean and variance are those of all
    /// that was measured anywhere.
    bool known = false;
};

/// The mixture over (X, Lambda) of one modality (thesis 5.1), in the local frame of its
/// map, which it must not outlive. Const member functions may be called from several
/// threads at once.
class HGMM_EXPORT ModalityMap {
 public:
    ModalityMap(const ModalityGroup& group, int channel, const HierarchyParams& hierarchy);

    const std::string& name() const;
    /// Components over (X, Lambda) of the base [count].
    std::size_t size() const;
    /// The mixture over (X, Lambda) of a level; 0 is the base. Each upper level aims at
    /// HierarchyParams::levelRatio of the components below. Throws std::out_of_range for a
    /// level that does not exist.
    const Mixture<4>& mixture(std::size_t level = 0) const;
    /// Regression (5.6) and its variance (5.7) at a point of the local frame.
    ModalityEstimate at(const Eigen::Vector3d& point) const;
    /// p(Lambda = value | x), thesis eq. (5.2) [1/unit]; zero where nothing is known.
    double density(double value, const Eigen::Vector3d& point) const;
    /// Bytes that the modality adds to a compactly saved map; places shared with other
    /// modalities count in equal parts.
    std::size_t savedBytes() const;

    const ModalityGroup& group() const { return *group_; }
    int channel() const { return channel_; }

 private:
    const ModalityGroup* group_;
    int channel_;
    HierarchyParams hierarchy_;
};

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
