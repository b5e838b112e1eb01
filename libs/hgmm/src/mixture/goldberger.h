#pragma once
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "hgmm/divergence.h"
#include "mixture/bound_tree.h"

namespace hgmm {

/// A component, and the same ready for divergences.
template <int D>
struct PreparedGaussian {
    Gaussian<D> gaussian;
    WhitenedGaussian<D> whitened;

    PreparedGaussian() = default;
    explicit PreparedGaussian(const Gaussian<D>& g) : gaussian(g), whitened(g) {}
};

/// What bounds divergences of a component. Factoring may raise pivots to 1e-12.
template <int D>
typename BoundTree<D>::Item boundItem(const Gaussian<D>& g, double logWeight) {
    typename BoundTree<D>::Item item;
    for (int a = 0; a < D; ++a) {
        item.mean[a] = g.mean[a];
        item.variance[a] = g.covariance(a, a) + 1e-12;
    }
    item.logWeight = logWeight;
    return item;
}

/// A component, and its least cost.
struct GoldbergerMatch {
    double cost = std::numeric_limits<double>::infinity();  ///< [nat]
    std::uint32_t component = 0;
};

/// KL(f || g) + log(pi / tau) for a component f of weight pi and one of q, of weight tau.
template <int D>
double goldbergerCost(const PreparedGaussian<D>& f, double logWeight,
                      const PreparedGaussian<D>& g, double otherLogWeight) {
    return klDivergence(f.whitened, f.gaussian.covariance, g.whitened) +
           (logWeight - otherLogWeight);
}

/// Whether KL(f || g) may be at most `most` for gaps between their means along the axes and
/// variances of g.
template <int D, typename Gap>
bool mayBeWithin(double most, Gap&& gap, const typename BoundTree<D>::Point& variance) {
    const double twice = 2 * most * (1 + 1e-9);  // with a margin for rounding
    bool may = twice >= 0;
    for (int a = 0; a < D; ++a) may &= gap(a) * gap(a) <= twice * variance[a];
    return may;
}

/// Finds min_j KL(f || q_j) + log(pi / tau_j) over the components of a mixture q, the term
/// of Goldberger's approximation (thesis eq. (3.15)): the result of the full search.
/// Replaces `best` by the best component if that is better.
/// @param tree of q, with the logarithms of weights
/// @param part part(k) returns component k of q, a PreparedGaussian
/// @param f, logWeight a component, and log pi of it in its own mixture
template <int D, typename PartOf>
void improveMatch(const BoundTree<D>& tree, PartOf&& part, const PreparedGaussian<D>& f,
                  double logWeight, GoldbergerMatch& best) {
    const auto from = boundItem(f.gaussian, 0.0).mean;
    const auto mayHold = [&](const typename BoundTree<D>::Node& node) {
        return mayBeWithin<D>(
            best.cost - logWeight + node.heaviest, [&](int a) { return node.gap(from, a); },
            node.widest);
    };
    tree.visit(from, mayHold, [&](std::uint32_t k) {
        const auto& item = tree.item(k);
        if (!mayBeWithin<D>(
                best.cost - logWeight + item.logWeight,
                [&](int a) { return item.mean[a] - from[a]; }, item.variance))
            return;
        const double cost = goldbergerCost(f, logWeight, part(k), item.logWeight);
        if (cost < best.cost) best = {cost, k};
    });
}

/// The same in a mixture of its own.
template <int D>
class GoldbergerSearch {
 public:
    explicit GoldbergerSearch(const Mixture<D>& q) {
        const double total = q.totalSupport();
        std::vector<typename BoundTree<D>::Item> items;
        for (std::size_t j = 0; j < q.size(); ++j) {
            parts_.emplace_back(q[j]);
            items.push_back(boundItem<D>(q[j], portable::log(q.weight(j, total))));
        }
        tree_ = BoundTree<D>(std::move(items));
    }

    void improve(const PreparedGaussian<D>& f, double logWeight,
                 GoldbergerMatch& best) const {
        const auto part = [this](std::uint32_t k) -> const PreparedGaussian<D>& {
            return parts_[k];
        };
        improveMatch(tree_, part, f, logWeight, best);
    }

 private:
    std::vector<PreparedGaussian<D>> parts_;
    BoundTree<D> tree_;
};

}  // namespace hgmm
