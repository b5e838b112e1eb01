#include "hgmm/evaluation/roc.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

void requireScores(const std::vector<double>& scores) {
    if (scores.empty()) throw std::invalid_argument("scores: a class is empty");
    for (const double score : scores)
        if (std::isnan(score)) throw std::invalid_argument("scores: one is not a number");
}

std::vector<double> falling(std::vector<double> scores) {
    std::sort(scores.begin(), scores.end(), std::greater<>());
    return scores;
}

double share(std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

RocCurve rocCurve(const std::vector<double>& positives,
                  const std::vector<double>& negatives) {
    requireScores(positives);
    requireScores(negatives);
    const std::vector<double> p = falling(positives), n = falling(negatives);
    RocCurve curve{{0.0, 0.0}};
    std::size_t above = 0, falseAbove = 0;  // scores at or above the threshold
    while (above < p.size() || falseAbove < n.size()) {
        double threshold = above < p.size() ? p[above] : n[falseAbove];
        if (falseAbove < n.size()) threshold = std::max(threshold, n[falseAbove]);
        while (above < p.size() && p[above] == threshold) ++above;
        while (falseAbove < n.size() && n[falseAbove] == threshold) ++falseAbove;
        curve.push_back({share(falseAbove, n.size()), share(above, p.size())});
    }
    return curve;
}

double areaUnder(const RocCurve& curve) {
    double area = 0.0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        area += 0.5 * (curve[i].fpr - curve[i - 1].fpr) * (curve[i].tpr + curve[i - 1].tpr);
    return area;
}

double tprAt(const RocCurve& curve, double fpr) {
    std::size_t i = 1;
    while (i < curve.size() && curve[i].fpr <= fpr) ++i;
    if (i == curve.size()) return curve.back().tpr;
    const RocPoint &before = curve[i - 1], &after = curve[i];
    return before.tpr +
           (fpr - before.fpr) / (after.fpr - before.fpr) * (after.tpr - before.tpr);
}

RocCurve thinned(const RocCurve& curve, double step) {
    RocCurve kept;
    for (const RocPoint& point : curve) {
        const bool moved = kept.empty() || std::abs(point.fpr - kept.back().fpr) >= step ||
                           std::abs(point.tpr - kept.back().tpr) >= step;
        if (moved) kept.push_back(point);
    }
    if (!curve.empty() &&
        (kept.back().fpr != curve.back().fpr || kept.back().tpr != curve.back().tpr))
        kept.push_back(curve.back());
    return kept;
}

double balancedAccuracy(const std::vector<double>& occupied,
                        const std::vector<double>& free) {
    requireScores(occupied);
    requireScores(free);
    const auto saidOccupied = [](const std::vector<double>& scores) {
        const auto n = std::count_if(scores.begin(), scores.end(),
                                     [](double score) { return score > 0.5; });
        return share(static_cast<std::size_t>(n), scores.size());
    };
    return 0.5 * (saidOccupied(occupied) + 1.0 - saidOccupied(free));
}

}  // namespace hgmm::evaluation
