#pragma once
#include <cstdint>
#include <vector>

#include "modality/channel_mixture.h"

namespace hgmm {

/// Finds the components that most likely hold a value of a channel, thesis eq. (5.9), at a
/// cost that does not depend on how many there are: the range of values is cut into
/// intervals, each with its kCandidates components of largest weight at its centre.
class ValueIndex {
 public:
    static constexpr std::size_t kCandidates = 32;

    ValueIndex(const ChannelMixture& mixture, int channel);

    /// Components, by falling weight; at most kCandidates. None where no component is
    /// within 4 sigma.
    struct Range {
        const std::uint32_t* first;
        const std::uint32_t* last;
        const std::uint32_t* begin() const { return first; }
        const std::uint32_t* end() const { return last; }
    };
    Range at(double value) const;

    /// log of phi(value; mu_kLambda, Sigma_kLambdaLambda) of eq. (5.9), up to a constant.
    double logDensity(std::uint32_t k, double value) const {
        const double d = (value - marginals_[k].mean) * marginals_[k].perSigma;
        return marginals_[k].logPerSigma - 0.5 * d * d;
    }

    std::size_t liveBytes() const {
        return (begin_.capacity() + component_.capacity()) * sizeof(std::uint32_t) +
               marginals_.capacity() * sizeof(Marginal);
    }

 private:
    struct Marginal {
        double mean, perSigma, logPerSigma;
    };

    std::vector<Marginal> marginals_;  ///< of every component over the channel
    double low_ = 0, perInterval_ = 0;
    std::vector<std::uint32_t> begin_{0, 0};  ///< per interval and one more
    std::vector<std::uint32_t> component_;
};

}  // namespace hgmm
