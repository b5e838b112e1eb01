#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/portable_math.h"
#include "hgmm/em.h"
#include "hgmm/gaussian.h"
#include "mixture/regularized.h"

namespace hgmm::em {

inline constexpr double kNever = -std::numeric_limits<double>::infinity();

template <int D>
using Packed = std::array<double, packedSize(D)>;

/// One sample in double precision.
template <int D>
struct Sample {
    double support;
    std::array<double, D> mean;
    Packed<D> covariance;
};

/// One component, ready for the E-step.
template <int D>
struct Component {
    Gaussian<D> gaussian;
    std::array<double, D> mean;
    Packed<D> precision;  ///< off-diagonal entries doubled: <precision, M> = trace(P M)
    double
        logWeightedPeak;  ///< log(pi N(mu | mu, Sigma)); -infinity once it lost its support
};

/// C + d d^T and d = mean(sample) - mean(component): what the E-step weighs and the M-step
/// sums.
template <int D>
struct SecondMoment {
    std::array<double, D> offset;
    Packed<D> about;

    SecondMoment(const Sample<D>& sample, const std::array<double, D>& mean) {
        for (int a = 0; a < D; ++a) offset[a] = sample.mean[a] - mean[a];
        for (int a = 0, k = 0; a < D; ++a)
            for (int b = a; b < D; ++b, ++k)
                about[k] = sample.covariance[k] + offset[a] * offset[b];
    }
};

/// The neighbourhoods seen from the components: entries of component j are
/// entry[begin[j]] .. entry[begin[j + 1]], in rising order of sample.
struct Members {
    std::vector<std::uint32_t> begin, entry, sample;
};

inline Members transpose(const Neighbourhoods& n, std::size_t components) {
    Members m;
    m.begin.assign(components + 1, 0);
    for (const std::uint32_t j : n.component) ++m.begin[j + 1];
    for (std::size_t j = 0; j < components; ++j) m.begin[j + 1] += m.begin[j];
    m.entry.resize(n.component.size());
    m.sample.resize(n.component.size());
    std::vector<std::uint32_t> next(m.begin.begin(), m.begin.end() - 1);
    for (std::size_t i = 0; i + 1 < n.begin.size(); ++i)
        for (std::uint32_t e = n.begin[i]; e < n.begin[i + 1]; ++e) {
            const std::uint32_t place = next[n.component[e]]++;
            m.entry[place] = e;
            m.sample[place] = static_cast<std::uint32_t>(i);
        }
    return m;
}

/// Fewer neighbourhood entries are not worth waking threads for [count].
inline constexpr std::size_t kParallelEntries = 200000;

/// EM over fixed neighbourhoods. The E-step writes each sample's responsibilities, the
/// M-step sums each component's members in order of sample: no sum depends on the number of
/// threads.
template <int D>
class Fit {
 public:
    Fit(const Mixture<D>& samples, const Mixture<D>& initial,
        const Neighbourhoods& neighbourhoods);

    /// Responsibilities, thesis eq. (3.8); returns the mean expected log-likelihood
    /// [nat/point].
    double expect();
    /// Parameters that maximise eq. (3.9): thesis eq. (3.10)-(3.12).
    void maximise();
    Mixture<D> mixture() const;

 private:
    void loadSamples(const Mixture<D>& samples);
    void prepare(Component<D>& component) const;
    double expectSample(std::size_t i);
    void maximiseComponent(std::size_t j);

    const Neighbourhoods& neighbourhoods_;
    Members members_;
    std::vector<Sample<D>> samples_;
    std::vector<Component<D>> components_;
    std::vector<double> responsibility_;  ///< one per neighbourhood entry
    std::vector<double> logLikelihood_;   ///< one per sample [nat]
    double total_ = 0;                    ///< support of all samples [count]
    double lostSupport_ = 0;              ///< a component with less is gone [count]
    double varianceFloor_ = 0;            ///< [m^2]
};

template <int D>
Fit<D>::Fit(const Mixture<D>& samples, const Mixture<D>& initial,
            const Neighbourhoods& neighbourhoods)
    : neighbourhoods_(neighbourhoods),
      members_(transpose(neighbourhoods, initial.size())),
      responsibility_(neighbourhoods.component.size()),
      logLikelihood_(samples.size()) {
    loadSamples(samples);
    components_.resize(initial.size());
    const double scale = total_ / initial.totalSupport();
    for (std::size_t j = 0; j < initial.size(); ++j) {
        components_[j].gaussian = initial[j];
        components_[j].gaussian.support *= scale;
        prepare(components_[j]);
    }
}

template <int D>
void Fit<D>::loadSamples(const Mixture<D>& samples) {
    using Vector = typename Gaussian<D>::Vector;
    total_ = samples.totalSupport();
    Vector mean = Vector::Zero();
    double lightest = total_;
    std::size_t most = 1;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Gaussian<D> g = samples[i];
        mean += g.support / total_ * g.mean;
        lightest = std::min(lightest, g.support);
        most = std::max<std::size_t>(
            most, neighbourhoods_.begin[i + 1] - neighbourhoods_.begin[i]);
    }
    // The likeliest neighbour of a sample takes at least 1/most of it, so no sample can be
    // left without a living component.
    lostSupport_ = 1e-6 * lightest / static_cast<double>(most);

    double variance = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Gaussian<D> g = samples[i];
        variance +=
            g.support / total_ * (g.covariance.trace() + (g.mean - mean).squaredNorm());
    }
    // Noise that every sample is granted, so that raw points on a line still span a volume.
    // As part of the data, rather than of the M-step, it cannot make the likelihood fall.
    varianceFloor_ = std::max(1e-12, 1e-10 * variance / D);

    samples_.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples_[i].support = samples.support[i];
        for (int a = 0; a < D; ++a) samples_[i].mean[a] = samples.mean[a][i];
        for (int k = 0; k < packedSize(D); ++k)
            samples_[i].covariance[k] = samples.covariance[k][i];
        for (int a = 0; a < D; ++a)
            samples_[i].covariance[packedIndex(D, a, a)] += varianceFloor_;
    }
}

template <int D>
void Fit<D>::prepare(Component<D>& component) const {
    const WhitenedGaussian<D> whitened(component.gaussian, 0.5 * varianceFloor_);
    for (int a = 0; a < D; ++a) component.mean[a] = component.gaussian.mean[a];
    for (int a = 0, k = 0; a < D; ++a)
        for (int b = a; b < D; ++b, ++k) {
            double entry = 0;
            for (int row = b; row < D; ++row)
                entry += whitened.factor(row, a) * whitened.factor(row, b);
            component.precision[k] = a == b ? entry : 2 * entry;
        }
    component.logWeightedPeak =
        portable::log(component.gaussian.support / total_) + whitened.logNormalizer();
}

template <int D>
double Fit<D>::expectSample(std::size_t i) {
    const std::uint32_t first = neighbourhoods_.begin[i],
                        last = neighbourhoods_.begin[i + 1];
    double likeliest = kNever;
    for (std::uint32_t e = first; e < last; ++e) {
        const Component<D>& component = components_[neighbourhoods_.component[e]];
        const SecondMoment<D> moment(samples_[i], component.mean);
        double distance = 0;
        for (int k = 0; k < packedSize(D); ++k)
            distance += component.precision[k] * moment.about[k];
        responsibility_[e] = component.logWeightedPeak - 0.5 * distance;
        likeliest = std::max(likeliest, responsibility_[e]);
    }
    double sum = 0;
    for (std::uint32_t e = first; e < last; ++e) {
        const double relative = responsibility_[e] - likeliest;
        // A share of exp(-20) moves no parameter that is kept as a float.
        responsibility_[e] = relative < -20 ? 0 : portable::exp(relative);
        sum += responsibility_[e];
    }
    for (std::uint32_t e = first; e < last; ++e) responsibility_[e] /= sum;
    return likeliest + portable::log(sum);
}

template <int D>
double Fit<D>::expect() {
    const auto n = static_cast<std::ptrdiff_t>(samples_.size());
#pragma omp parallel for schedule(static) if (responsibility_.size() > kParallelEntries)
    for (std::ptrdiff_t i = 0; i < n; ++i) logLikelihood_[i] = expectSample(i);
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i)
        sum += samples_[i].support * logLikelihood_[i];  // thesis eq. (3.4)
    return sum / total_;
}

template <int D>
void Fit<D>::maximiseComponent(std::size_t j) {
    Component<D>& component = components_[j];
    double support = 0;
    std::array<double, D> first{};
    Packed<D> second{};
    for (std::uint32_t m = members_.begin[j]; m < members_.begin[j + 1]; ++m) {
        const double r = responsibility_[members_.entry[m]];
        if (r == 0) continue;
        const Sample<D>& sample = samples_[members_.sample[m]];
        const SecondMoment<D> moment(sample, component.mean);
        const double share = r * sample.support;
        support += share;
        for (int a = 0; a < D; ++a) first[a] += share * moment.offset[a];
        for (int k = 0; k < packedSize(D); ++k) second[k] += share * moment.about[k];
    }
    if (support < lostSupport_) {
        component.gaussian.support = 0;
        component.logWeightedPeak = kNever;
        return;
    }
    component.gaussian.support = support;  // thesis eq. (3.12), times N
    for (int a = 0; a < D; ++a) {
        first[a] /= support;
        component.gaussian.mean[a] = component.mean[a] + first[a];  // thesis eq. (3.10)
    }
    for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b)
            component.gaussian.covariance(a, b) = second[packedIndex(D, a, b)] / support -
                                                  first[a] * first[b];  // thesis eq. (3.11)
    prepare(component);
}

template <int D>
void Fit<D>::maximise() {
    const auto n = static_cast<std::ptrdiff_t>(components_.size());
#pragma omp parallel for schedule(static) if (responsibility_.size() > kParallelEntries)
    for (std::ptrdiff_t j = 0; j < n; ++j) maximiseComponent(j);
}

template <int D>
Mixture<D> Fit<D>::mixture() const {
    Mixture<D> out;
    out.reserve(components_.size());
    for (const Component<D>& component : components_)
        if (component.gaussian.support > 0) out.pushBack(regularized(component.gaussian));
    return out;
}

}  // namespace hgmm::em
