#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "goldberger.h"
#include "hgmm/divergence.h"
#include "storable.h"

namespace hgmm {

/// One pass of Algorithm 1, lines 6-16, with the result of the plain double loop.
///
/// A pair can only merge if min(KL(f || g), KL(g || f)) < lambda, and KL(f || g) is at
/// least (mu_f - mu_g)_a^2 / (2 Sigma_g,aa) along any axis a. Partners are therefore sought
/// in a window of the components sorted along one axis.
template <int D>
class MergeSweep {
 public:
    MergeSweep(const Mixture<D>& mixture, double similarity);

    /// The components left, in order of the first of those merged into each.
    Mixture<D> run();
    /// After run(): index in its result of the component that took over each component.
    const std::vector<std::uint32_t>& heirs() const { return heirs_; }
    /// After run(): whether each component of its result took over others.
    const std::vector<bool>& merged() const { return merged_; }

 private:
    struct Part {
        Gaussian<D> gaussian;
        WhitenedGaussian<D> whitened;
        bool absorbed = false;
    };

    /// Merges part i with its partners; whether it had any.
    bool absorbLater(std::size_t i);
    /// Later components than `after` that pass the bound against part i, in rising order.
    void findCandidates(const Part& part, std::size_t after);
    bool passesBound(const Gaussian<D>& a, const Gaussian<D>& b) const;
    bool similar(const Part& a, const Part& b) const;

    double similarity_;
    double twiceSimilarity_;  ///< with a margin for rounding
    int axis_ = 0;
    double widest_ = 0;  ///< largest variance along the axis [m^2]
    std::vector<Part> parts_;
    std::vector<std::pair<double, std::uint32_t>>
        sorted_;  ///< position along the axis, index
    std::vector<std::uint32_t> candidates_;
    std::vector<std::uint32_t> heirs_;
    std::vector<bool> merged_;
};

template <int D>
MergeSweep<D>::MergeSweep(const Mixture<D>& mixture, double similarity)
    : similarity_(similarity), twiceSimilarity_(2 * similarity * (1 + 1e-9)) {
    if (mixture.empty()) return;
    axis_ = widestAxis(mixture);
    parts_.reserve(mixture.size());
    sorted_.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<D> g = mixture[i];
        parts_.push_back({g, WhitenedGaussian<D>(g)});
        sorted_.emplace_back(g.mean[axis_], static_cast<std::uint32_t>(i));
        widest_ = std::max(widest_, g.covariance(axis_, axis_));
    }
    std::sort(sorted_.begin(), sorted_.end());
}

template <int D>
Mixture<D> MergeSweep<D>::run() {
    Mixture<D> left;
    left.reserve(parts_.size());
    heirs_.resize(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (parts_[i].absorbed) continue;
        heirs_[i] = static_cast<std::uint32_t>(left.size());
        merged_.push_back(absorbLater(i));
        // What did not merge stays bit for bit.
        left.pushBack(merged_.back() ? storable(parts_[i].gaussian) : parts_[i].gaussian);
    }
    return left;
}

template <int D>
bool MergeSweep<D>::absorbLater(std::size_t i) {
    Part& part = parts_[i];
    bool absorbedAny = false;
    findCandidates(part, i);
    for (std::size_t c = 0; c < candidates_.size();) {
        const std::size_t j = candidates_[c++];
        if (!similar(part, parts_[j])) continue;
        parts_[j].absorbed = absorbedAny = true;
        heirs_[j] = heirs_[i];
        part.gaussian = mergeMoments(part.gaussian, parts_[j].gaussian);
        part.whitened = WhitenedGaussian<D>(part.gaussian);
        // The part has moved and grown: its partners among the rest are others now.
        findCandidates(part, j);
        c = 0;
    }
    return absorbedAny;
}

template <int D>
void MergeSweep<D>::findCandidates(const Part& part, std::size_t after) {
    candidates_.clear();
    const Gaussian<D>& g = part.gaussian;
    const double reach = std::sqrt(twiceSimilarity_ *
                                   (std::max(widest_, g.covariance(axis_, axis_)) + 1e-12));
    auto entry = std::lower_bound(sorted_.begin(), sorted_.end(),
                                  std::make_pair(g.mean[axis_] - reach, std::uint32_t{0}));
    for (; entry != sorted_.end() && entry->first <= g.mean[axis_] + reach; ++entry) {
        const std::uint32_t j = entry->second;
        if (j <= after || parts_[j].absorbed) continue;
        const Gaussian<D>& other = parts_[j].gaussian;
        if (passesBound(g, other) || passesBound(other, g)) candidates_.push_back(j);
    }
    std::sort(candidates_.begin(), candidates_.end());
}

template <int D>
bool MergeSweep<D>::passesBound(const Gaussian<D>& a, const Gaussian<D>& b) const {
    for (int axis = 0; axis < D; ++axis) {
        const double gap = a.mean[axis] - b.mean[axis];
        const double variance =
            b.covariance(axis, axis) + 1e-12;  // factoring raises pivots
        if (gap * gap > twiceSimilarity_ * variance) return false;
    }
    return true;
}

template <int D>
bool MergeSweep<D>::similar(const Part& a, const Part& b) const {
    return klDivergence(a.whitened, a.gaussian.covariance, b.whitened) < similarity_ ||
           klDivergence(b.whitened, b.gaussian.covariance, a.whitened) < similarity_;
}

}  // namespace hgmm
