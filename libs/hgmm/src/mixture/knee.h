#pragma once
#include <cstddef>
#include <vector>

#include "hgmm/hierarchy.h"

namespace hgmm {

/// Whether a mixture may be the fidelity threshold of a reference mixture: at least a
/// twelfth of its size. Smaller ones are left out of the search for the knee, or the
/// collapse of the last few components into one would drown it. Chosen on planted mixtures
/// (tests/hgmm/knee_test.cpp), where a tenth to a fifteenth serve.
bool isFidelityCandidate(const DivergencePoint& point, const DivergencePoint& reference);

/// Index of the knee of a divergence curve (sizes falling), i.e. the smallest mixture whose
/// divergence has not begun to climb: the fidelity threshold of thesis 3.3.2.
///
/// Method: two-phase regression, after D. J. Hudson, "Fitting segmented curves whose join
/// points have to be estimated", J. Am. Stat. Assoc. 61 (1966). Two joined straight
/// lines of divergence over size are fitted by least squares to the points that
/// isFidelityCandidate() admits, with the joint at each inner point in turn; the knee is
/// the joint of least error.
///
/// A curve of fewer than four such points, or one that is straight, flattens or never
/// climbs, has no knee; then the result is the point of least divergence (the smallest
/// mixture, if several). An empty curve gives 0.
std::size_t findKnee(const std::vector<DivergencePoint>& curve);

}  // namespace hgmm
