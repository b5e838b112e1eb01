#pragma once
#include <Eigen/Core>
#include <vector>

#include "hgmm/modality.h"
#include "modality/modality_group.h"

namespace hgmm {

/// A prior with its model.
struct Prior {
    const ModalityMap* map;
    double value;
};

/// Thesis 5.2: candidate places from the components that weigh most at the priors' values
/// (5.9), (5.10), of which the one with the largest sum of likelihoods (5.12), (5.14) and a
/// model of the target is chosen, the first of equals; there the target is regressed
/// (5.13).
/// @param point local frame; null if it is not known
CrossModalEstimate inferModality(const ModalityMap& target,
                                 const std::vector<Prior>& priors,
                                 const Eigen::Vector3d* point);

}  // namespace hgmm
