#pragma once
#include <vector>

namespace hgmm::evaluation {

/// How well a threshold on scores tells positives from negatives.
struct RocPoint {
    double fpr = 0.0;  ///< share of negatives at or above the threshold, [0, 1]
    double tpr = 0.0;  ///< share of positives at or above the threshold, [0, 1]
};

/// Receiver operating characteristic, from (0, 0) to (1, 1), one point for each threshold
/// that changes anything. Where positives and negatives tie, straight lines join the
/// points: what a random choice among the tied attains.
using RocCurve = std::vector<RocPoint>;

/// Throws std::invalid_argument if a class is empty or a score is NaN.
RocCurve rocCurve(const std::vector<double>& positives,
                  const std::vector<double>& negatives);

/// Area under the curve, in [0, 1]: the probability that a positive outscores a negative,
/// ties counting half (average ranks; Mann-Whitney).
double areaUnder(const RocCurve& curve);

/// The true positive rate that a false positive rate in [0, 1] allows.
double tprAt(const RocCurve& curve, double fpr);

/// The curve for drawing: points closer than `step` to the last one kept are left out.
RocCurve thinned(const RocCurve& curve, double step);

/// Mean of the shares answered right, an answer above 0.5 meaning occupied and any other
/// free. Throws like rocCurve.
double balancedAccuracy(const std::vector<double>& occupied,
                        const std::vector<double>& free);

}  // namespace hgmm::evaluation
