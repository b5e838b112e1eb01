#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/portable_math.h"
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
/// are compared (BoundTree).
template <int D>
class Agglomeration {
 public:
    using Part = PreparedGaussian<D>;

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
    /// Logarithm of a component's share of those left, as of that pass.
    double logWeight(std::uint32_t row) const { return tree_.item(row).logWeight; }
    /// The row of the component left that explains f best (improveMatch), as of that pass.
    void improve(const Part& f, double logWeight, GoldbergerMatch& best) const {
        const auto part = [this](std::uint32_t row) -> const Part& { return parts_[row]; };
        improveMatch(tree_, part, f, logWeight, best);
    }
    /// The row of the component that holds the one of a row now.
    std::uint32_t heirOf(std::uint32_t row) const;
    /// Index in mixture() of the component that holds each of the first mixture.
    std::vector<std::uint32_t> parents() const;

 private:
    static constexpr double kFirstHorizon = 2.0;  ///< [nat]

    struct Pair {
        std::uint32_t row;
        double distance;  ///< [nat], below the horizon
    };
    using Pairs = std::vector<Pair>;

    void widenHorizon(double similarity);
    /// Merges later rows into row i; whether there were any.
    bool absorbLater(std::uint32_t i, double similarity);
    /// Components left, other than row i, that are nearer than `limit`.
    void findPairs(std::uint32_t i, double limit, Pairs& pairs) const;
    double distance(const Part& a, const Part& b) const {
        return std::min(klDivergence(a.whitened, a.gaussian.covariance, b.whitened),
                        klDivergence(b.whitened, b.gaussian.covariance, a.whitened));
    }
    void findLeastDistance();
    /// What is stored of the components that grew, and pairs with them.
    void settleGrown();
    /// Brings the tree up to date with the components that are left.
    void refitTree();
    double totalSupport() const;

    double horizon_ = kFirstHorizon;  ///< pairs at least as far apart are not kept [nat]
    double least_ = 0.0;              ///< of the distances kept, or the horizon [nat]
    std::vector<Part> parts_;
    std::vector<Pairs> pairs_;              ///< of each row
    std::vector<std::uint32_t> alive_;      ///< rows left, rising
    std::vector<std::uint32_t> takenOver_;  ///< of each row: by which, itself if left
    std::vector<std::uint32_t> grown_;
    std::vector<bool> hasGrown_;
    BoundTree<D> tree_;  ///< by row
};

template <int D>
Agglomeration<D>::Agglomeration(const Mixture<D>& mixture)
    : pairs_(mixture.size()), hasGrown_(mixture.size(), false) {
    if (mixture.empty()) return;
    parts_.reserve(mixture.size());
    std::vector<typename BoundTree<D>::Item> items;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        parts_.emplace_back(mixture[i]);
        alive_.push_back(static_cast<std::uint32_t>(i));
        items.push_back(boundItem(parts_[i].gaussian, 0.0));
    }
    takenOver_ = alive_;
    tree_ = BoundTree<D>(std::move(items));
    refitTree();
    widenHorizon(horizon_);
}

template <int D>
void Agglomeration<D>::refitTree() {
    const double total = totalSupport();
    for (const std::uint32_t i : alive_)
        tree_.item(i).logWeight = portable::log(parts_[i].gaussian.support / total);
    tree_.refit();
}

template <int D>
void Agglomeration<D>::widenHorizon(double similarity) {
    while (horizon_ < similarity) horizon_ *= 2;
    for (const std::uint32_t i : alive_) pairs_[i].clear();
    Pairs later;
    for (const std::uint32_t i : alive_) {
        findPairs(i, horizon_, later);
        for (const Pair& pair : later) {
            if (pair.row < i) continue;
            pairs_[i].push_back(pair);
            pairs_[pair.row].push_back({i, pair.distance});
        }
    }
    findLeastDistance();
}

template <int D>
void Agglomeration<D>::findPairs(std::uint32_t i, double limit, Pairs& pairs) const {
    pairs.clear();
    const Part& part = parts_[i];
    const auto own = boundItem(part.gaussian, 0.0);
    // Whether components may be similar, either way round.
    const auto may = [&](auto&& gap, const typename BoundTree<D>::Point& variance) {
        return mayBeWithin<D>(limit, gap, variance) ||
               mayBeWithin<D>(limit, gap, own.variance);
    };
    const auto mayHold = [&](const typename BoundTree<D>::Node& node) {
        return may([&](int a) { return node.gap(own.mean, a); }, node.widest);
    };
    tree_.visit(own.mean, mayHold, [&](std::uint32_t j) {
        const auto& item = tree_.item(j);
        if (j == i || takenOver_[j] != j ||
            !may([&](int a) { return item.mean[a] - own.mean[a]; }, item.variance))
            return;
        const double apart = distance(part, parts_[j]);
        if (apart < limit) pairs.push_back({j, apart});
    });
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
    for (const std::uint32_t i : alive_) tree_.item(i).isLeft = takenOver_[i] == i;
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
        part = Part(mergeMoments(part.gaussian, parts_[next].gaussian));
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
        parts_[grown_[k]] = Part(stored[k]);
        tree_.item(grown_[k]) = boundItem(parts_[grown_[k]].gaussian, 0.0);
    }
    refitTree();
    for (const std::uint32_t i : alive_) {
        Pairs& pairs = pairs_[i];
        pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                                   [&](const Pair& pair) {
                                       return takenOver_[pair.row] != pair.row ||
                                              hasGrown(pair.row);
                                   }),
                    pairs.end());
    }
    for (const std::uint32_t i : grown_) findPairs(i, horizon_, pairs_[i]);
    for (const std::uint32_t i : grown_)
        for (const Pair& pair : pairs_[i])
            if (!hasGrown(pair.row)) pairs_[pair.row].push_back({i, pair.distance});
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
