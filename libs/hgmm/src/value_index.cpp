#include "value_index.h"

#include <algorithm>
#include <cmath>

namespace hgmm {

namespace {

constexpr std::size_t kIntervals = 256;
constexpr double kSigmas = 4.0;

/// The marginal of a component over the channel: one term of thesis eq. (5.9).
struct Marginal {
    double mean, sigma, logPeak;

    double logWeight(double value) const {
        const double d = (value - mean) / sigma;
        return logPeak - 0.5 * d * d;
    }
};

std::vector<Marginal> marginalsOf(const ChannelMixture& mixture, int channel) {
    std::vector<Marginal> all;
    all.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<4> g = mixture[i].joint(channel);
        const double sigma = std::sqrt(g.covariance(3, 3));
        all.push_back({g.mean[3], sigma, std::log(g.support) - std::log(sigma)});
    }
    return all;
}

}  // namespace

ValueIndex::ValueIndex(const ChannelMixture& mixture, int channel) {
    if (mixture.empty()) return;
    const std::vector<Marginal> all = marginalsOf(mixture, channel);
    double high = low_ = all[0].mean;
    for (const Marginal& m : all) {
        low_ = std::min(low_, m.mean - kSigmas * m.sigma);
        high = std::max(high, m.mean + kSigmas * m.sigma);
    }
    perInterval_ = double(kIntervals) / (high - low_);
    struct Entry {
        double logWeight;
        std::uint32_t component;
        bool operator<(const Entry& o) const {
            return logWeight != o.logWeight ? logWeight > o.logWeight
                                            : component < o.component;
        }
    };
    std::vector<std::vector<Entry>> intervals(kIntervals);
    for (std::uint32_t i = 0; i < all.size(); ++i) {
        const auto intervalOf = [&](double value) {
            return static_cast<std::size_t>(
                std::clamp((value - low_) * perInterval_, 0.0, double(kIntervals - 1)));
        };
        const std::size_t last = intervalOf(all[i].mean + kSigmas * all[i].sigma);
        for (std::size_t k = intervalOf(all[i].mean - kSigmas * all[i].sigma); k <= last;
             ++k) {
            const double centre = low_ + (double(k) + 0.5) / perInterval_;
            intervals[k].push_back({all[i].logWeight(centre), i});
        }
    }
    begin_.assign(1, 0);
    for (std::vector<Entry>& entries : intervals) {
        const std::size_t kept = std::min(kCandidates, entries.size());
        std::partial_sort(entries.begin(), entries.begin() + std::ptrdiff_t(kept),
                          entries.end());
        for (std::size_t k = 0; k < kept; ++k) component_.push_back(entries[k].component);
        begin_.push_back(static_cast<std::uint32_t>(component_.size()));
    }
}

ValueIndex::Range ValueIndex::at(double value) const {
    const double interval = std::floor((value - low_) * perInterval_);
    if (!(interval >= 0 && interval < double(begin_.size() - 1)))
        return {component_.data(), component_.data()};
    const auto k = static_cast<std::size_t>(interval);
    return {component_.data() + begin_[k], component_.data() + begin_[k + 1]};
}

}  // namespace hgmm
