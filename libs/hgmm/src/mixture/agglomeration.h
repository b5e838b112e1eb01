#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "hgmm/divergence.h"
#include "mixture/goldberger.h"
#include "mixture/regularized.h"

namespace hgmm {

/// Algorithm 1 of the thesis, lines 6-16, pass after pass on one mixture, each with the
/// result of the plain double loop.
///
/// The distance of a pair is min(KL(f || g), KL(g || f)). Distances are kept from pass to
/// pass and found anew for components that merged, so a pass at a similarity below the
/// least of them costs nothing. KL(f || g) is at least
/// (mu_f - mu_g)_a^2 / (2 Sigma_g,aa) along any axis a: only components that this allows
/// are compared.
template <int D>
class Agglomeration {
 public:
    struct Part {
        Gaussian<D> gaussian;
        WhitenedGaussian<D> whitened;
    };

    explicit Agglomeration(const Mixture<D>& mixture);

    /// One pass at a similarity [nat]; whether any components merged. A component takes
    /// over later ones, nearest rows first, and is compared anew after each.
    bool pass(double similarity);

    std::size_t size() const { return alive_.size(); }
    /// Components left, in order of the first of those merged into each.
    Mixture<D> mixture() const;
    /// Rows of the components left, rising; a row is an index of the first mixture.
    const std::vector<std::uint32_t>& rows() const { return alive_; }
    /// Rows of the components that took over others in the last pass that merged any.
    const std::vector<std::uint32_t>& grown() const { return grown_; }
    bool hasGrown(std::uint32_t row) const { return hasGrown_[row]; }
    const Part& part(std::uint32_t row) const { return parts_[row]; }
    /// The axis along which the first mixture's means spread most.
    int axis() const { return axis_; }
    /// Of the components left [count].
    double totalSupport() const;
    /// The row of the component that holds the one of a row now.
    std::uint32_t heirOf(std::uint32_t row) const;
    /// Index in mixture() of the component that holds each of the first mixture.
    std::vector<std::uint32_t> parents() const;

 private:
    static constexpr double kLeastVariance = 1e-12;  ///< factoring raises pivots to this
    static constexpr double kFirstHorizon = 2.0;     ///< [nat]

    struct Pair {
        std::uint32_t row;
        double distance;  ///< [nat], below the horizon
    };
    using Pairs = std::vector<Pair>;

    void widenHorizon(double similarity);
    /// Sorts what the bound needs of the components left along the axis.
    void sortPlaces();
    /// Merges later rows into row i; whether there were any.
    bool absorbLater(std::uint32_t i, double similarity);
    /// Components left, other than row i, at places from `first` on and nearer than
    /// `limit`.
    void findPairs(std::uint32_t i, std::size_t first, double limit, Pairs& pairs) const;
    /// Of all places.
    void findPairs(std::uint32_t i, double limit, Pairs& pairs) const {
        const double reach = reachOf(parts_[i].gaussian, limit);
        const std::vector<double>& along = means_[axis_];
        const auto first = std::lower_bound(along.begin(), along.end(),
                                            parts_[i].gaussian.mean[axis_] - reach);
        findPairs(i, static_cast<std::size_t>(first - along.begin()), limit, pairs);
    }
    /// How far along the axis the bound lets a component nearer than `limit` be [m].
    double reachOf(const Gaussian<D>& g, double limit) const {
        const double own = g.covariance(axis_, axis_) + kLeastVariance;
        return std::sqrt(twice(limit) * std::max(widest_, own));
    }
    static double twice(double limit) {
        return 2 * limit * (1 + 1e-9);  // with a margin for rounding
    }
    bool passesBound(const Gaussian<D>& g, std::size_t place, double perTwice) const;
    double distance(const Part& a, const Part& b) const {
        return std::min(klDivergence(a.whitened, a.gaussian.covariance, b.whitened),
                        klDivergence(b.whitened, b.gaussian.covariance, a.whitened));
    }
    void findLeastDistance();
    /// What is stored of the components that grew, and pairs with them.
    void settleGrown();

    int axis_ = 0;
    double horizon_ = kFirstHorizon;  ///< pairs at least as far apart are not kept [nat]
    double least_ = 0.0;              ///< of the distances kept, or the horizon [nat]
    std::vector<Part> parts_;
    std::vector<Pairs> pairs_;              ///< of each row
    std::vector<std::uint32_t> alive_;      ///< rows left, rising
    std::vector<std::uint32_t> takenOver_;  ///< of each row: by which, itself if left
    std::vector<std::uint32_t> grown_;
    std::vector<bool> hasGrown_;

    std::vector<std::uint32_t> place_;                      ///< rows sorted along the axis
    std::array<std::vector<double>, D> means_, variances_;  ///< by place
    double widest_ = 0.0;                                   ///< largest variance [m^2]
};

template <int D>
Agglomeration<D>::Agglomeration(const Mixture<D>& mixture)
    : pairs_(mixture.size()), hasGrown_(mixture.size(), false) {
    if (mixture.empty()) return;
    axis_ = widestAxis(mixture);
    parts_.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<D> g = mixture[i];
        parts_.push_back({g, WhitenedGaussian<D>(g)});
        alive_.push_back(static_cast<std::uint32_t>(i));
    }
    takenOver_ = alive_;
    sortPlaces();
    widenHorizon(horizon_);
}

template <int D>
void Agglomeration<D>::sortPlaces() {
    std::vector<std::pair<double, std::uint32_t>> along;
    along.reserve(alive_.size());
    for (const std::uint32_t i : alive_)
        along.emplace_back(parts_[i].gaussian.mean[axis_], i);
    std::sort(along.begin(), along.end());
    place_.clear();
    widest_ = 0.0;
    for (int d = 0; d < D; ++d) means_[d].clear(), variances_[d].clear();
    for (const auto& entry : along) {
        const Gaussian<D>& g = parts_[entry.second].gaussian;
        place_.push_back(entry.second);
        for (int d = 0; d < D; ++d) {
            means_[d].push_back(g.mean[d]);
            variances_[d].push_back(g.covariance(d, d) + kLeastVariance);
        }
        widest_ = std::max(widest_, variances_[axis_].back());
    }
}

template <int D>
void Agglomeration<D>::widenHorizon(double similarity) {
    while (horizon_ < similarity) horizon_ *= 2;
    for (const std::uint32_t i : alive_) pairs_[i].clear();
    Pairs later;
    for (std::size_t k = 0; k < place_.size(); ++k) {
        const std::uint32_t i = place_[k];
        findPairs(i, k + 1, horizon_, later);
        for (const Pair& pair : later) {
            pairs_[i].push_back(pair);
            pairs_[pair.row].push_back({i, pair.distance});
        }
    }
    findLeastDistance();
}

/// Whether g and the component at `place` may be similar, either way round.
template <int D>
bool Agglomeration<D>::passesBound(const Gaussian<D>& g, std::size_t place,
                                   double perTwice) const {
    bool oneWay = true, otherWay = true;
    for (int d = 0; d < D; ++d) {
        const double gap = g.mean[d] - means_[d][place];
        const double bounded = gap * gap * perTwice;
        oneWay &= bounded <= variances_[d][place];
        otherWay &= bounded <= g.covariance(d, d) + kLeastVariance;
    }
    return oneWay || otherWay;
}

template <int D>
void Agglomeration<D>::findPairs(std::uint32_t i, std::size_t first, double limit,
                                 Pairs& pairs) const {
    pairs.clear();
    const Part& part = parts_[i];
    const std::vector<double>& along = means_[axis_];
    const double last = part.gaussian.mean[axis_] + reachOf(part.gaussian, limit);
    const double perTwice = 1 / twice(limit);
    for (std::size_t place = first; place < along.size() && along[place] <= last; ++place) {
        const std::uint32_t j = place_[place];
        if (j == i || takenOver_[j] != j || !passesBound(part.gaussian, place, perTwice))
            continue;
        const double apart = distance(part, parts_[j]);
        if (apart < limit) pairs.push_back({j, apart});
    }
}

template <int D>
void Agglomeration<D>::findLeastDistance() {
    least_ = horizon_;
    for (const std::uint32_t i : alive_)
        for (const Pair& pair : pairs_[i]) least_ = std::min(least_, pair.distance);
}

template <int D>
bool Agglomeration<D>::pass(double similarity) {
    if (alive_.empty()) return false;
    if (similarity > horizon_) widenHorizon(similarity);
    if (!(least_ < similarity)) return false;
    for (const std::uint32_t i : grown_) hasGrown_[i] = false;
    grown_.clear();
    for (const std::uint32_t i : alive_)
        if (takenOver_[i] == i && absorbLater(i, similarity)) {
            grown_.push_back(i);
            hasGrown_[i] = true;
        }
    alive_.erase(std::remove_if(alive_.begin(), alive_.end(),
                                [&](std::uint32_t i) { return takenOver_[i] != i; }),
                 alive_.end());
    settleGrown();
    return true;
}

template <int D>
bool Agglomeration<D>::absorbLater(std::uint32_t i, double similarity) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    Part& part = parts_[i];
    Pairs afterGrowth;
    const Pairs* pairs = &pairs_[i];
    std::uint32_t after = i;
    while (true) {
        std::uint32_t next = kNone;
        for (const Pair& pair : *pairs)
            if (pair.distance < similarity && pair.row > after && pair.row < next &&
                takenOver_[pair.row] == pair.row)
                next = pair.row;
        if (next == kNone) return after != i;
        takenOver_[next] = i;
        part.gaussian = mergeMoments(part.gaussian, parts_[next].gaussian);
        part.whitened = WhitenedGaussian<D>(part.gaussian);
        // The part has moved and grown: its partners among the rest are others now.
        findPairs(i, similarity, afterGrowth);
        pairs = &afterGrowth;
        after = next;
    }
}

template <int D>
void Agglomeration<D>::settleGrown() {
    Mixture<D> stored;  // in floats, as a level is
    for (const std::uint32_t i : grown_) stored.pushBack(regularized(parts_[i].gaussian));
    for (std::size_t k = 0; k < grown_.size(); ++k) {
        const Gaussian<D> g = stored[k];
        parts_[grown_[k]] = {g, WhitenedGaussian<D>(g)};
    }
    sortPlaces();
    for (const std::uint32_t i : alive_) {
        Pairs& pairs = pairs_[i];
        pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                                   [&](const Pair& pair) {
                                       return takenOver_[pair.row] != pair.row ||
                                              hasGrown_[pair.row];
                                   }),
                    pairs.end());
    }
    for (const std::uint32_t i : grown_) findPairs(i, horizon_, pairs_[i]);
    for (const std::uint32_t i : grown_)
        for (const Pair& pair : pairs_[i])
            if (!hasGrown_[pair.row]) pairs_[pair.row].push_back({i, pair.distance});
    findLeastDistance();
}

template <int D>
Mixture<D> Agglomeration<D>::mixture() const {
    Mixture<D> left;
    left.reserve(alive_.size());
    for (const std::uint32_t i : alive_) left.pushBack(parts_[i].gaussian);
    return left;
}

template <int D>
double Agglomeration<D>::totalSupport() const {
    double total = 0;
    for (const std::uint32_t i : alive_) total += parts_[i].gaussian.support;
    return total;
}

template <int D>
std::uint32_t Agglomeration<D>::heirOf(std::uint32_t row) const {
    while (takenOver_[row] != row) row = takenOver_[row];
    return row;
}

template <int D>
std::vector<std::uint32_t> Agglomeration<D>::parents() const {
    std::vector<std::uint32_t> index(parts_.size());
    for (std::size_t k = 0; k < alive_.size(); ++k)
        index[alive_[k]] = static_cast<std::uint32_t>(k);
    std::vector<std::uint32_t> parents(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i)
        parents[i] = index[heirOf(static_cast<std::uint32_t>(i))];
    return parents;
}

}  // namespace hgmm
