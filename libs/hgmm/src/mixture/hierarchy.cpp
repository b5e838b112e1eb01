#include "hgmm/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hgmm/params.h"
#include "mixture/agglomeration.h"
#include "mixture/goldberger.h"
#include "mixture/knee.h"

namespace hgmm {

namespace {

/// KL(G_0 || G_l) for one level after the other. A component of G_0 keeps its counterpart
/// in G_l as long as that does not merge; then only merged ones can have come nearer.
template <int D>
class ReferenceDivergence {
 public:
    explicit ReferenceDivergence(const Mixture<D>& reference) {
        if (reference.empty()) return;
        const GoldbergerSearch<D> search(reference);
        const double total = reference.totalSupport();
        terms_.reserve(reference.size());
        for (std::size_t i = 0; i < reference.size(); ++i) {
            const Gaussian<D> g = reference[i];
            const double weight = reference.weight(i, total);
            terms_.push_back({g, WhitenedGaussian<D>(g), weight, std::log(weight), {}});
            search.improve(g, terms_[i].whitened, terms_[i].logWeight, terms_[i].best);
        }
    }

    /// @param levels after a pass that merged some
    double to(const Agglomeration<D>& levels) {
        const GoldbergerSearch<D> all(levels, levels.rows()), grown(levels, levels.grown());
        double sum = 0;
        for (Term& t : terms_) {
            t.best.component = levels.heirOf(t.best.component);
            if (levels.hasGrown(t.best.component)) {
                t.best.cost = std::numeric_limits<double>::infinity();
                all.improve(t.gaussian, t.whitened, t.logWeight, t.best);
            } else {
                grown.improve(t.gaussian, t.whitened, t.logWeight, t.best);
            }
            sum += t.weight * t.best.cost;
        }
        return sum;
    }

 private:
    struct Term {
        Gaussian<D> gaussian;
        WhitenedGaussian<D> whitened;
        double weight, logWeight;
        typename GoldbergerSearch<D>::Match best;  ///< a row of the latest level
    };
    std::vector<Term> terms_;
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
    ReferenceDivergence<D> divergence(reference);
    Hierarchy<D> out;
    std::vector<Mixture<D>>& levels = out.levels;
    levels.push_back(reference);
    out.curve.push_back({reference.size(), 0.0, 0.0});

    Agglomeration<D> agglomeration(reference);
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
