#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "base/lattice.h"
#include "hgmm/divergence.h"
#include "mixture/goldberger.h"
#include "mixture/regularized.h"

namespace hgmm {

/// One pass of Algorithm 1, lines 6-16, with the result of the plain double loop.
///
/// A pair can only merge if min(KL(f || g), KL(g || f)) < lambda, and KL(f || g) is at
/// least (mu_f - mu_g)_a^2 / (2 Sigma_g,aa) along any axis a. Partners are therefore sought
/// in windows of the components sorted along one axis, one window for each class of size,
/// so that a few wide components do not widen the search for all.
template <int D>
class MergeSweep {
 public:
    MergeSweep(const Mixture<D>& mixture, double similarity);

    /// The components left, in order of the first of those merged into each.
    Mixture<D> run();
    /// After run(): index in its result of the component that took over each component.
    const std::vector<std::uint32_t>& parentOf() const { return parentOf_; }
    /// After run(): whether each component of its result took over others.
    const std::vector<bool>& merged() const { return merged_; }

 private:
    /// Places begin .. end hold parts of one octave of variance along the axis.
    struct SizeClass {
        std::size_t begin, end;
        double widest;  ///< largest variance along the axis [m^2]
    };
    struct Part {
        Gaussian<D> gaussian;
        WhitenedGaussian<D> whitened;
        bool absorbed = false;
    };

    /// Merges part i with its partners; whether it had any.
    bool absorbLater(std::size_t i);
    /// Later components than `after` that pass the bound against part i, in rising order.
    void findCandidates(const Part& part, std::size_t after);
    bool passesBound(const Gaussian<D>& g, std::size_t place) const;
    /// Groups parts by the octave of their variance along the axis, each sorted along it.
    void sortIntoClasses();
    bool similar(const Part& a, const Part& b) const;

    static constexpr double kLeastVariance = 1e-12;  ///< factoring raises pivots to this

    double similarity_;
    double twiceSimilarity_;  ///< with a margin for rounding
    double perTwiceSimilarity_;
    int axis_ = 0;
    std::vector<Part> parts_;
    std::vector<SizeClass> classes_;
    /// What the bound needs of the parts as they were at first, by place, so that a search
    /// streams through it. Merged parts are only ever the one that searches.
    std::array<std::vector<double>, D> means_, variances_;
    std::vector<std::uint32_t> order_;  ///< part at each place
    std::vector<std::uint32_t> candidates_;
    std::vector<std::uint32_t> parentOf_;
    std::vector<bool> merged_;
};

template <int D>
MergeSweep<D>::MergeSweep(const Mixture<D>& mixture, double similarity)
    : similarity_(similarity),
      twiceSimilarity_(2 * similarity * (1 + 1e-9)),
      perTwiceSimilarity_(1 / twiceSimilarity_) {
    if (mixture.empty()) return;
    axis_ = widestAxis(mixture);
    parts_.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<D> g = mixture[i];
        parts_.push_back({g, WhitenedGaussian<D>(g)});
        order_.push_back(static_cast<std::uint32_t>(i));
    }
    sortIntoClasses();
}

template <int D>
void MergeSweep<D>::sortIntoClasses() {
    const auto variance = [this](std::uint32_t i) {
        return parts_[i].gaussian.covariance(axis_, axis_) + kLeastVariance;
    };
    std::vector<int> octaves;
    for (const std::uint32_t i : order_) octaves.push_back(octaveOf(variance(i)));
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double alongA = parts_[a].gaussian.mean[axis_],
                     alongB = parts_[b].gaussian.mean[axis_];
        return std::tie(octaves[a], alongA, a) < std::tie(octaves[b], alongB, b);
    });
    for (std::size_t place = 0; place < order_.size(); ++place) {
        const std::uint32_t i = order_[place];
        if (place == 0 || octaves[i] != octaves[order_[place - 1]])
            classes_.push_back({place, place, 0.0});
        classes_.back().end = place + 1;
        classes_.back().widest = std::max(classes_.back().widest, variance(i));
        for (int d = 0; d < D; ++d) {
            means_[d].push_back(parts_[i].gaussian.mean[d]);
            variances_[d].push_back(parts_[i].gaussian.covariance(d, d) + kLeastVariance);
        }
    }
}

template <int D>
Mixture<D> MergeSweep<D>::run() {
    Mixture<D> left;
    left.reserve(parts_.size());
    parentOf_.resize(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (parts_[i].absorbed) continue;
        parentOf_[i] = static_cast<std::uint32_t>(left.size());
        merged_.push_back(absorbLater(i));
        // What did not merge stays bit for bit.
        left.pushBack(merged_.back() ? regularized(parts_[i].gaussian)
                                     : parts_[i].gaussian);
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
        parentOf_[j] = parentOf_[i];
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
    const double middle = g.mean[axis_];
    const double own = g.covariance(axis_, axis_) + kLeastVariance;
    const std::vector<double>& along = means_[axis_];
    for (const SizeClass& size : classes_) {
        const double reach = std::sqrt(twiceSimilarity_ * std::max(size.widest, own));
        auto place = static_cast<std::size_t>(
            std::lower_bound(along.begin() + std::ptrdiff_t(size.begin),
                             along.begin() + std::ptrdiff_t(size.end), middle - reach) -
            along.begin());
        for (; place < size.end && along[place] <= middle + reach; ++place) {
            if (!passesBound(g, place)) continue;
            const std::uint32_t j = order_[place];
            if (j > after && !parts_[j].absorbed) candidates_.push_back(j);
        }
    }
    std::sort(candidates_.begin(), candidates_.end());
}

/// Whether g and the part at `place` may be similar, either way round.
template <int D>
bool MergeSweep<D>::passesBound(const Gaussian<D>& g, std::size_t place) const {
    bool oneWay = true, otherWay = true;
    for (int axis = 0; axis < D; ++axis) {
        const double gap = g.mean[axis] - means_[axis][place];
        const double bounded = gap * gap * perTwiceSimilarity_;
        oneWay &= bounded <= variances_[axis][place];
        otherWay &= bounded <= g.covariance(axis, axis) + kLeastVariance;
    }
    return oneWay || otherWay;
}

template <int D>
bool MergeSweep<D>::similar(const Part& a, const Part& b) const {
    return klDivergence(a.whitened, a.gaussian.covariance, b.whitened) < similarity_ ||
           klDivergence(b.whitened, b.gaussian.covariance, a.whitened) < similarity_;
}

}  // namespace hgmm
