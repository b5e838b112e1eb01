#include "modality/value_index.h"

#include <algorithm>
#include <cmath>

namespace hgmm {

namespace {

constexpr std::size_t kIntervals = 256;
constexpr double kIntervalSigmas = 4.0;

}  // namespace

ValueIndex::ValueIndex(const ChannelMixture& mixture, int channel) {
    if (mixture.empty()) return;
    marginals_.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<4> g = mixture[i].joint(channel);
        const double perSigma = 1 / std::sqrt(g.covariance(3, 3));
        marginals_.push_back({g.mean[3], perSigma, std::log(perSigma)});
    }
    double high = low_ = marginals_[0].mean;
    for (const Marginal& m : marginals_) {
        low_ = std::min(low_, m.mean - kIntervalSigmas / m.perSigma);
        high = std::max(high, m.mean + kIntervalSigmas / m.perSigma);
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
    for (std::uint32_t i = 0; i < marginals_.size(); ++i) {
        const auto intervalOf = [&](double sigmas) {
            const double value = marginals_[i].mean + sigmas / marginals_[i].perSigma;
            return static_cast<std::size_t>(
                std::clamp((value - low_) * perInterval_, 0.0, double(kIntervals - 1)));
        };
        const double logSupport = std::log(double(mixture.places().support[i]));
        const std::size_t last = intervalOf(kIntervalSigmas);
        for (std::size_t k = intervalOf(-kIntervalSigmas); k <= last; ++k) {
            const double centre = low_ + (double(k) + 0.5) / perInterval_;
            intervals[k].push_back({logSupport + logDensity(i, centre), i});
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
