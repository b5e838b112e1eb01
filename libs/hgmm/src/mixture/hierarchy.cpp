#include "hgmm/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "hgmm/params.h"
#include "mixture/agglomeration.h"
#include "mixture/knee.h"

namespace hgmm {

namespace {

/// KL(G_0 || G_l) for one level after the other. A component of G_0 keeps its counterpart
/// in G_l as long as that does not merge; then only merged ones can have come nearer: each
/// of these, which are few, looks for components of G_0 that it may serve.
template <int D>
class ReferenceDivergence {
 public:
    /// @param levels before any pass
    ReferenceDivergence(const Mixture<D>& reference, const Agglomeration<D>& levels) {
        const double total = reference.totalSupport();
        std::vector<typename BoundTree<D>::Item> items;
        for (std::uint32_t i = 0; i < reference.size(); ++i) {
            const double weight = reference.weight(i, total);
            terms_.push_back({levels.part(i), weight, portable::log(weight), {}});
            matchWith(levels, i, terms_[i]);
            items.push_back(boundItem(terms_[i].part.gaussian, 0.0));
        }
        tree_ = BoundTree<D>(std::move(items));
        refitTree();
        for (const std::uint32_t row : levels.rows()) offer(levels, row);
    }

    /// @param levels after a pass that merged some
    double to(const Agglomeration<D>& levels) {
        for (Term& t : terms_) {
            const std::uint32_t row = levels.heirOf(t.best.component);
            if (!levels.hasGrown(row)) continue;
            const double former = t.best.cost;
            matchWith(levels, row, t);
            // Those that did not grow cost no less than the former counterpart.
            if (t.best.cost > former) levels.improve(t.part, t.logWeight, t.best);
        }
        refitTree();
        for (const std::uint32_t row : levels.grown()) offer(levels, row);
        double sum = 0;
        for (const Term& t : terms_) sum += t.weight * t.best.cost;
        return sum;
    }

 private:
    struct Term {
        PreparedGaussian<D> part;
        double weight, logWeight;
        GoldbergerMatch best;  ///< a row of the latest level
    };

    static void matchWith(const Agglomeration<D>& levels, std::uint32_t row, Term& t) {
        t.best = {
            goldbergerCost(t.part, t.logWeight, levels.part(row), levels.logWeight(row)),
            row};
    }
    void refitTree() {
        for (std::uint32_t i = 0; i < terms_.size(); ++i)
            tree_.item(i).logWeight = terms_[i].best.cost - terms_[i].logWeight;
        tree_.refit();
    }
    /// Makes a component of a level the counterpart of all that it serves better.
    void offer(const Agglomeration<D>& levels, std::uint32_t row) {
        const PreparedGaussian<D>& g = levels.part(row);
        const double logWeight = levels.logWeight(row);
        const auto own = boundItem(g.gaussian, logWeight);
        const auto mayHold = [&](const typename BoundTree<D>::Node& node) {
            return mayBeWithin<D>(
                node.heaviest + logWeight, [&](int a) { return node.gap(own.mean, a); },
                own.variance);
        };
        tree_.visit(own.mean, mayHold, [&](std::uint32_t i) {
            Term& t = terms_[i];
            const auto& mean = tree_.item(i).mean;
            if (!mayBeWithin<D>(
                    t.best.cost - t.logWeight + logWeight,
                    [&](int a) { return mean[a] - own.mean[a]; }, own.variance))
                return;
            const double cost = goldbergerCost(t.part, t.logWeight, g, logWeight);
            if (cost < t.best.cost) t.best = {cost, row};
        });
    }

    std::vector<Term> terms_;
    BoundTree<D> tree_;  ///< of the reference; its logWeight is what a counterpart may cost
};

double raised(double similarity, double step) {
    return similarity + step * std::max(1.0, similarity / 4);
}

/// Later points cannot change findKnee(): they are no candidates, and the divergence
/// climbs.
bool kneeIsKnown(const std::vector<DivergencePoint>& curve) {
    return !isFidelityCandidate(curve.back(), curve.front()) && curve.size() > 1 &&
           curve.back().divergence > curve[curve.size() - 2].divergence;
}

}  // namespace

template <int D>
Mixture<D> mergePass(const Mixture<D>& mixture, double similarity) {
    Agglomeration<D> levels(mixture);
    levels.pass(similarity);
    return levels.mixture();
}

template <int D>
Mixture<D> mergeToSize(const Mixture<D>& mixture, std::size_t size,
                       const HierarchyParams& params,
                       std::vector<std::uint32_t>* parentOf) {
    Agglomeration<D> levels(mixture);
    double similarity = params.similarityStart;
    while (levels.size() > size && similarity < HierarchyParams::kLargestSimilarity) {
        levels.pass(similarity);
        const double next = raised(similarity, params.similarityStep);
        if (next == similarity) break;
        similarity = next;
    }
    if (parentOf != nullptr) *parentOf = levels.parents();
    return levels.mixture();
}

template <int D>
Hierarchy<D> generateHierarchy(const Mixture<D>& reference, const HierarchyParams& params) {
    params.validate();
    Hierarchy<D> out;
    std::vector<Mixture<D>>& levels = out.levels;
    levels.push_back(reference);
    out.curve.push_back({reference.size(), 0.0, 0.0});

    Agglomeration<D> agglomeration(reference);
    ReferenceDivergence<D> divergence(reference, agglomeration);
    double similarity = params.similarityStart;
    const auto pass = [&] {
        const bool smaller = agglomeration.pass(similarity);
        if (smaller) {
            const double kl = divergence.to(agglomeration);
            out.curve.push_back({agglomeration.size(), kl, similarity});
            levels.push_back(agglomeration.mixture());
        }
        const bool mayMerge = smaller || params.similarityStep > 0;
        similarity = raised(similarity, params.similarityStep);
        return mayMerge && levels.back().size() > 1 &&
               similarity < HierarchyParams::kLargestSimilarity;
    };
    bool more = reference.size() > 1;
    while (more && !kneeIsKnown(out.curve)) more = pass();
    out.knee = findKnee(out.curve);
    while (out.curve[out.knee].similarity > params.similarityMax) --out.knee;
    const std::size_t wanted = out.knee + static_cast<std::size_t>(params.levels);
    while (more && levels.size() < wanted) more = pass();

    levels.erase(levels.begin(), levels.begin() + static_cast<std::ptrdiff_t>(out.knee));
    levels.resize(std::min(levels.size(), static_cast<std::size_t>(params.levels)));
    return out;
}

template Mixture<3> mergePass(const Mixture<3>&, double);
template Mixture<3> mergeToSize(const Mixture<3>&, std::size_t, const HierarchyParams&,
                                std::vector<std::uint32_t>*);
template Mixture<4> mergeToSize(const Mixture<4>&, std::size_t, const HierarchyParams&,
                                std::vector<std::uint32_t>*);
template Hierarchy<2> generateHierarchy(const Mixture<2>&, const HierarchyParams&);
template Hierarchy<3> generateHierarchy(const Mixture<3>&, const HierarchyParams&);

}  // namespace hgmm
