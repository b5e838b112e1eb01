#pragma once
#include <cstddef>

#include "hgmm/evaluation/gp_regression.h"
#include "hgmm/mixture.h"

namespace replay {

/// Regression of y over x by a mixture over (x, y) that learns set by set and keeps no
/// data: the stages of chapter 3 with their default rules, and thesis eq. (4.17), (4.18).
///
/// - Overestimate: initialiseFromCells() with the smallest cells of CellParams, for cells
///   that follow a sensor's range have no meaning here, and EM. An overestimate of 50
///   puts the knee at 9 to 22 components (thesis: 14), and below 20 the curvature of the
///   sine within a component counts as variance, whatever EM does.
/// - Fidelity threshold: generateHierarchy() (Algorithm 1).
/// - First mixture: EM of so many components from cells over x of equally many samples.
///   Merging in the order of Algorithm 1 leaves components of very different lengths, near
///   a poor optimum of the likelihood that neither EM nor updates leave.
/// - Further sets: thesis eq. (3.19)-(3.22). All samples count as known, for the first set
///   covers the interval.
class MixtureRegression {
 public:
    /// @param firstSet points (x, y); throws std::invalid_argument if empty
    explicit MixtureRegression(const hgmm::Mixture<2>& firstSet);

    void update(const hgmm::Mixture<2>& set);

    const hgmm::Mixture<2>& mixture() const { return mixture_; }
    /// Components of the overestimate, after EM.
    std::size_t overestimate() const { return overestimate_; }

 private:
    hgmm::Mixture<2> mixture_;
    std::size_t overestimate_ = 0;
};

}  // namespace replay
