#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/gaussian.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// One component of a mixture over (X, W), ready to be regressed (thesis 4.1.2): X are the
/// first D - 1 axes, W is the last.
///
/// A covariance that is not positive definite is treated as WhitenedGaussian does: pivots
/// below 1e-12 are raised, so that all results stay finite. The library has it for D = 2
/// and 4.
template <int D>
class RegressedGaussian {
 public:
    RegressedGaussian() = default;
    /// @param weight pi_j, > 0
    RegressedGaussian(const Gaussian<D>& joint, double weight);

    /// log(pi_j phi(x; mu_jX, Sigma_jXX)) [nat]: one term of thesis eq. (4.7).
    double logWeightedDensity(const double* x) const {
        return logWeight_ + place_.logPdf(x);
    }
    /// m_j(x), thesis eq. (4.5) [unit of W].
    double mean(const double* x) const {
        double m = meanW_;
        for (int a = 0; a < D - 1; ++a) m += slope_[a] * (x[a] - place_.mean(a));
        return m;
    }
    /// sigma_j^2, thesis eq. (4.6) [unit of W squared], > 0, the same for all x.
    double variance() const { return variance_; }
    /// d m_j / d x_a = (Sigma_jXX^-1 Sigma_jXW)_a.
    double slope(int axis) const { return slope_[axis]; }

 private:
    WhitenedGaussian<D - 1> place_;
    std::array<double, D - 1> slope_{};
    double meanW_ = 0;
    double variance_ = 1;
    double logWeight_ = 0;
};

/// What a mixture says about W at one x: a mixture of Gaussians in one dimension, thesis
/// eq. (4.8). It can be reused for many x (ConditionalMixture::at).
class HGMM_EXPORT Conditional {
 public:
    /// One term of thesis eq. (4.8).
    struct Term {
        double weight;    ///< w_j(x), thesis eq. (4.9), in [0, 1]; all sum to one
        double mean;      ///< m_j(x), thesis eq. (4.5) [unit of W]
        double variance;  ///< sigma_j^2, thesis eq. (4.6) [unit of W squared], > 0
    };

    /// One for each component, in the mixture's order.
    const std::vector<Term>& terms() const { return terms_; }
    /// log p_X(x), thesis eq. (4.7) [nat]: how much the mixture knows about x.
    double logMarginal() const { return logMarginal_; }
    /// log p(w | x), thesis eq. (4.8) [nat].
    double logDensity(double w) const;
    /// m(x) = E[W | x], thesis eq. (4.17) [unit of W].
    double mean() const;
    /// v(x) = Var[W | x], thesis eq. (4.18) [unit of W squared], > 0; summed about the
    /// mean, so that no digits cancel.
    double variance() const;
    /// P(low <= W <= high | x), in [0, 1]: the integrals of thesis eq. (4.15) and (4.16).
    /// Ends may be infinite. Throws std::invalid_argument if low > high or one is NaN.
    double mass(double low, double high) const;

 private:
    template <int D>
    friend class ConditionalMixture;

    std::vector<Term> terms_;
    double logMarginal_ = 0;
};

/// A mixture over (X, W) made ready for questions about W given X = x (thesis 4.1.2 and
/// 4.3.1): each component is factored once.
///
/// Weights (4.9) are formed in log space. Far from all components (4.9) reads 0/0; here the
/// component of largest density there takes the whole weight, so that answers extrapolate
/// its regression line and stay finite. Only logMarginal() tells that nothing is known.
template <int D>
class ConditionalMixture {
 public:
    /// Throws std::invalid_argument if the mixture is empty.
    explicit ConditionalMixture(const Mixture<D>& joint);

    /// @param x D - 1 numbers; throws std::invalid_argument if one is not finite or beyond
    /// 1e100.
    Conditional at(const double* x) const;
    /// The same into `out`, whose memory is used again: for batches.
    void at(const double* x, Conditional& out) const;

    std::size_t size() const { return components_.size(); }
    /// @param j < size()
    const RegressedGaussian<D>& component(std::size_t j) const { return components_[j]; }

 private:
    std::vector<RegressedGaussian<D>> components_;
};

template <int D>
ConditionalMixture<D>::ConditionalMixture(const Mixture<D>& joint) {
    if (joint.empty())
        throw std::invalid_argument("ConditionalMixture of an empty mixture");
    const double total = joint.totalSupport();
    components_.reserve(joint.size());
    for (std::size_t j = 0; j < joint.size(); ++j)
        components_.emplace_back(joint[j], joint.weight(j, total));
}

template <int D>
Conditional ConditionalMixture<D>::at(const double* x) const {
    Conditional out;
    at(x, out);
    return out;
}

template <int D>
void ConditionalMixture<D>::at(const double* x, Conditional& out) const {
    for (int a = 0; a < D - 1; ++a)
        if (!(std::abs(x[a]) <= 1e100))
            throw std::invalid_argument(
                "ConditionalMixture::at: a coordinate is not finite or beyond 1e100");
    out.terms_.resize(components_.size());
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < components_.size(); ++j) {
        const RegressedGaussian<D>& c = components_[j];
        out.terms_[j] = {c.logWeightedDensity(x), c.mean(x), c.variance()};
        largest = std::max(largest, out.terms_[j].weight);
    }
    double sum = 0;
    for (Conditional::Term& t : out.terms_) sum += t.weight = std::exp(t.weight - largest);
    for (Conditional::Term& t : out.terms_) t.weight /= sum;
    out.logMarginal_ = largest + std::log(sum);
}

/// The model of place alone where W = 0, thesis eq. (4.10) to (4.13): the surface within a
/// mixture over place and distance.
///
/// Supports are the weights (4.13) times the support of the whole, so that the total stays.
/// Components with a weight below 1e-12, which float supports cannot tell from none, are
/// left out. An empty mixture gives an empty one.
template <int D>
HGMM_EXPORT Mixture<D - 1> spatialModel(const Mixture<D>& joint);

extern template class HGMM_EXPORT RegressedGaussian<2>;
extern template class HGMM_EXPORT RegressedGaussian<4>;

}  // namespace hgmm
