#include <algorithm>
#include <array>
#include <cmath>

#include "hgmm/gaussian.h"
#include "hgmm/hierarchy.h"
#include "modality/modality_cache.h"
#include "modality/modality_group.h"
#include "modality/top_k.h"

namespace hgmm {

namespace {

constexpr double kPi = 3.14159265358979323846;

double normalDensity(double value, double mean, double variance) {
    const double d = value - mean;
    return std::exp(-0.5 * d * d / variance) / std::sqrt(2 * kPi * variance);
}

}  // namespace

ModalityGroup::ModalityGroup(std::vector<std::string> names, ChannelMixture mixture)
    : names_(std::move(names)),
      mixture_(std::move(mixture)),
      cache_(std::make_unique<Cache>()) {}
ModalityGroup::ModalityGroup(const ModalityGroup& o)
    : ModalityGroup(o.names_, o.mixture_) {}
ModalityGroup::ModalityGroup(ModalityGroup&& o) noexcept = default;
ModalityGroup& ModalityGroup::operator=(const ModalityGroup& o) {
    if (this != &o) *this = ModalityGroup(o);
    return *this;
}
ModalityGroup& ModalityGroup::operator=(ModalityGroup&& o) noexcept = default;
ModalityGroup::~ModalityGroup() = default;

ModalityGroup ModalityGroup::withNames(const std::vector<std::string>& names) const {
    std::vector<int> channels;
    for (const std::string& name : names)
        channels.push_back(static_cast<int>(std::find(names_.begin(), names_.end(), name) -
                                            names_.begin()));
    return ModalityGroup(names, mixture_.withChannels(channels));
}

ModalityGroup ModalityGroup::within(const Eigen::AlignedBox3f& box) const {
    const ComponentIndex places(PlaceIndex::kReachSigmas);
    std::vector<std::size_t> rows;
    for (std::size_t k = 0; k < mixture_.size(); ++k)
        if (places.reaches(mixture_.places()[k], box)) rows.push_back(k);
    return ModalityGroup(names_, mixture_.rows(rows));
}

const ModalityGroup::PlaceIndex& ModalityGroup::index() const {
    return cache_->index.get(
        [this] { return std::make_unique<PlaceIndex>(mixture_.places()); });
}

ModalityGroup::PlaceIndex& ModalityGroup::writableIndex() {
    index();
    return *cache_->index.value();
}

const ValueIndex& ModalityGroup::byValue(int channel) const {
    return cache_->byValue[static_cast<std::size_t>(channel)].get(
        [&] { return std::make_unique<ValueIndex>(mixture_, channel); });
}

const Mixture<4>& ModalityGroup::level(int channel, std::size_t level,
                                       const HierarchyParams& params) const {
    const auto c = static_cast<std::size_t>(channel);
    const Mixture<4>& base = cache_->base[c].get(
        [&] { return std::make_unique<Mixture<4>>(mixture_.joint(channel)); });
    if (level == 0) return base;
    return cache_->upper[c].get([&] {
        auto levels = std::make_unique<std::vector<Mixture<4>>>();
        const Mixture<4>* below = &base;
        for (int l = 1; l < params.levels; ++l) {
            const auto size = static_cast<std::size_t>(
                std::ceil(params.levelRatio * static_cast<double>(below->size())));
            levels->reserve(static_cast<std::size_t>(params.levels));
            levels->push_back(mergeToSize(*below, size, params));
            below = &levels->back();
        }
        return levels;
    })[level - 1];
}

template <typename Visitor>
void ModalityGroup::visitAround(const Eigen::Vector3d& point, Visitor&& visit) const {
    const ComponentIndex& components = index().components();
    const Eigen::Vector3f p = point.cast<float>();
    components.visitCandidates(p.x(), p.y(), p.z(), [&](std::uint32_t k) {
        const ComponentIndex::Factor& factor = components.factor(k);
        const float squared = factor.squaredMahalanobis(p.data());
        if (!(squared <= PlaceIndex::kReachSigmas * PlaceIndex::kReachSigmas)) return;
        // Within that reach of a component, densities are far from the ends of a double.
        const double logDensity = double(factor.logNormalizer()) - 0.5 * double(squared);
        visit(k, double(mixture_.places().support[k]) * std::exp(logDensity));
    });
}

double ModalityGroup::regressed(int channel, std::uint32_t k,
                                const Eigen::Vector3d& point) const {
    double mean = mixture_.mean(channel, k);
    for (int d = 0; d < 3; ++d)
        mean += double(mixture_.slope(channel, d, k)) *
                (point[d] - mixture_.places().mean[d][k]);
    return mean;
}

ModalityEstimate ModalityGroup::at(int channel, const Eigen::Vector3d& point) const {
    // Running mean and sum of squares about it, so that no digits cancel.
    double weight = 0, mean = 0, squares = 0;
    visitAround(point, [&](std::uint32_t k, double w) {
        weight += w;
        const double there = regressed(channel, k, point), before = there - mean;
        mean += w / weight * before;
        squares += w * (mixture_.residual(channel, k) + before * (there - mean));
    });
    if (weight > 0) return {mean, squares / weight, true};
    const Overall& all = overall(channel);
    return {all.mean, all.variance, false};
}

double ModalityGroup::density(const ChannelValue* values, std::size_t n,
                              const Eigen::Vector3d& point) const {
    double weight = 0, sum = 0;
    visitAround(point, [&](std::uint32_t k, double w) {
        weight += w;
        for (std::size_t i = 0; i < n; ++i)
            sum +=
                w * normalDensity(values[i].value, regressed(values[i].channel, k, point),
                                  mixture_.residual(values[i].channel, k));
    });
    return weight > 0 ? sum / weight : 0.0;
}

TopK ModalityGroup::likeliest(const ChannelValue& value,
                              const Eigen::Vector3d& point) const {
    TopK components;
    // The product of (5.9) and the density in (5.8) is that of place and value together.
    visitAround(point, [&](std::uint32_t k, double w) {
        components.offer(w * normalDensity(value.value, regressed(value.channel, k, point),
                                           mixture_.residual(value.channel, k)),
                         k);
    });
    return components;
}

const ModalityGroup::Overall& ModalityGroup::overall(int channel) const {
    return cache_->overall[static_cast<std::size_t>(channel)].get([&] {
        auto made = std::make_unique<Overall>();
        double weight = 0, squares = 0;
        for (std::size_t i = 0; i < mixture_.size(); ++i) {
            const Gaussian<4> g = mixture_[i].joint(channel);
            weight += g.support;
            const double before = g.mean[3] - made->mean;
            made->mean += g.support / weight * before;
            squares += g.support * (g.covariance(3, 3) + before * (g.mean[3] - made->mean));
        }
        if (weight > 0) made->variance = squares / weight;
        return made;
    });
}

std::size_t ModalityGroup::liveBytes() const {
    std::size_t bytes = sizeof(*this) + sizeof(Cache) + mixture_.liveBytes();
    for (const std::string& name : names_) bytes += sizeof(name) + name.capacity();
    if (const PlaceIndex* made = cache_->index.ready()) bytes += made->liveBytes();
    for (const auto& lazy : cache_->byValue)
        if (const ValueIndex* made = lazy.ready()) bytes += made->liveBytes();
    constexpr std::size_t perComponent = sizeof(float) * (1 + 4 + Mixture<4>::packed);
    for (const auto& lazy : cache_->base)
        if (const Mixture<4>* made = lazy.ready()) bytes += made->size() * perComponent;
    for (const auto& lazy : cache_->upper)
        if (const auto* made = lazy.ready())
            for (const Mixture<4>& level : *made) bytes += level.size() * perComponent;
    return bytes;
}

}  // namespace hgmm
