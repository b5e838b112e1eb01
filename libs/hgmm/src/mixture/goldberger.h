#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "hgmm/divergence.h"

namespace hgmm {

/// Finds min_j KL(f || q_j) + log(pi / tau_j) over the components of a mixture q, the term
/// of Goldberger's approximation (thesis eq. (3.15)), without looking at all of them.
///
/// For any axis a, KL(f || g) >= (mu_f - mu_g)_a^2 / (2 Sigma_g,aa). Components are visited
/// outwards from f along one axis until that bound, taken with the widest component and the
/// largest weight, exceeds the best value found: the result is that of the full search.
template <int D>
class GoldbergerSearch {
 public:
    /// @param q not empty
    explicit GoldbergerSearch(const Mixture<D>& q);
    /// Over some rows of a mixture that is being reduced (Agglomeration).
    /// @param rows of components that are left
    template <typename Levels>
    GoldbergerSearch(const Levels& q, const std::vector<std::uint32_t>& rows);

    struct Match {
        double cost = std::numeric_limits<double>::infinity();  ///< [nat]
        std::uint32_t component = 0;                            ///< of q, or its row
    };

    /// Replaces `best` by the best component if that is better.
    /// @param f, whitened the same Gaussian
    /// @param logWeight log pi of f in its own mixture
    void improve(const Gaussian<D>& f, const WhitenedGaussian<D>& whitened,
                 double logWeight, Match& best) const;

 private:
    struct Entry {
        typename Gaussian<D>::Vector mean, twiceVariance;
        double logWeight;
        std::uint32_t component;
        WhitenedGaussian<D> whitened;
    };

    void add(const Gaussian<D>& g, const WhitenedGaussian<D>& whitened, double weight,
             std::uint32_t component);
    void sortEntries();
    void tryEntry(const Entry& entry, const Gaussian<D>& f,
                  const WhitenedGaussian<D>& whitened, double logWeight, Match& best) const;
    /// No entry this far away along the axis can do better.
    bool outOfReach(const Entry& entry, const Gaussian<D>& f, double logWeight,
                    double best) const {
        const double gap = entry.mean[axis_] - f.mean[axis_];
        return gap * gap / twiceWidest_ + logWeight - heaviest_ > best;
    }

    int axis_ = 0;
    double twiceWidest_ = 0;  ///< twice the largest variance along the axis [m^2]
    double heaviest_ = -std::numeric_limits<double>::infinity();  ///< largest logWeight
    std::vector<Entry> entries_;                                  ///< sorted along the axis
};

/// The axis along which the means spread most.
template <int D>
int widestAxis(const Mixture<D>& mixture) {
    int widest = 0;
    float extent = -1;
    for (int a = 0; a < D; ++a) {
        const auto [low, high] =
            std::minmax_element(mixture.mean[a].begin(), mixture.mean[a].end());
        if (*high - *low > extent) {
            extent = *high - *low;
            widest = a;
        }
    }
    return widest;
}

template <int D>
GoldbergerSearch<D>::GoldbergerSearch(const Mixture<D>& q) : axis_(widestAxis(q)) {
    const double total = q.totalSupport();
    entries_.reserve(q.size());
    for (std::size_t j = 0; j < q.size(); ++j) {
        const Gaussian<D> g = q[j];
        add(g, WhitenedGaussian<D>(g), q.weight(j, total), static_cast<std::uint32_t>(j));
    }
    sortEntries();
}

template <int D>
template <typename Levels>
GoldbergerSearch<D>::GoldbergerSearch(const Levels& q,
                                      const std::vector<std::uint32_t>& rows)
    : axis_(q.axis()) {
    const double total = q.totalSupport();
    entries_.reserve(rows.size());
    for (const std::uint32_t row : rows) {
        const auto& part = q.part(row);
        add(part.gaussian, part.whitened, part.gaussian.support / total, row);
    }
    sortEntries();
}

template <int D>
void GoldbergerSearch<D>::add(const Gaussian<D>& g, const WhitenedGaussian<D>& whitened,
                              double weight, std::uint32_t component) {
    // Factoring may raise pivots to 1e-12.
    const typename Gaussian<D>::Vector twiceVariance =
        2.0 * (g.covariance.diagonal().array() + 1e-12).matrix();
    entries_.push_back({g.mean, twiceVariance, std::log(weight), component, whitened});
    twiceWidest_ = std::max(twiceWidest_, twiceVariance[axis_]);
    heaviest_ = std::max(heaviest_, entries_.back().logWeight);
}

template <int D>
void GoldbergerSearch<D>::sortEntries() {
    std::vector<std::pair<double, std::uint32_t>> along;
    along.reserve(entries_.size());
    for (const Entry& entry : entries_)
        along.emplace_back(entry.mean[axis_], static_cast<std::uint32_t>(along.size()));
    std::sort(along.begin(), along.end());
    std::vector<Entry> sorted;
    sorted.reserve(entries_.size());
    for (const auto& place : along) sorted.push_back(entries_[place.second]);
    entries_.swap(sorted);
}

template <int D>
void GoldbergerSearch<D>::tryEntry(const Entry& entry, const Gaussian<D>& f,
                                   const WhitenedGaussian<D>& whitened, double logWeight,
                                   Match& best) const {
    const double weightTerm = logWeight - entry.logWeight;
    for (int a = 0; a < D; ++a) {
        const double gap = entry.mean[a] - f.mean[a];
        if (gap * gap > (best.cost - weightTerm) * entry.twiceVariance[a] * (1 + 1e-9))
            return;
    }
    const double cost = klDivergence(whitened, f.covariance, entry.whitened) + weightTerm;
    if (cost < best.cost) best = {cost, entry.component};
}

template <int D>
void GoldbergerSearch<D>::improve(const Gaussian<D>& f, const WhitenedGaussian<D>& whitened,
                                  double logWeight, Match& best) const {
    const auto nearest = std::lower_bound(entries_.begin(), entries_.end(), f.mean[axis_],
                                          [this](const Entry& entry, double position) {
                                              return entry.mean[axis_] < position;
                                          });
    for (auto e = nearest; e != entries_.end() && !outOfReach(*e, f, logWeight, best.cost);
         ++e)
        tryEntry(*e, f, whitened, logWeight, best);
    for (auto e = nearest; e != entries_.begin();) {
        --e;
        if (outOfReach(*e, f, logWeight, best.cost)) break;
        tryEntry(*e, f, whitened, logWeight, best);
    }
}

}  // namespace hgmm
