#include <algorithm>
#include <array>
#include <cmath>

#include "hgmm/map.h"
#include "modality/cross_modal.h"
#include "modality/top_k.h"
#include "modality/value_index.h"

namespace hgmm {

namespace {

/// Priors of one group, whose densities at a place are found together.
struct GroupPriors {
    const ModalityGroup* group;
    std::array<ChannelValue, kMaxModalities> values;
    std::size_t count = 0;
};

std::vector<GroupPriors> byGroup(const std::vector<Prior>& priors) {
    std::vector<GroupPriors> groups;
    for (const Prior& prior : priors) {
        const ModalityGroup* group = &prior.map->group();
        auto at = std::find_if(groups.begin(), groups.end(),
                               [&](const GroupPriors& g) { return g.group == group; });
        if (at == groups.end()) at = groups.insert(at, {group, {}, 0});
        if (at->count < kMaxModalities)
            at->values[at->count++] = {prior.map->channel(), prior.value};
    }
    return groups;
}

/// Thesis eq. (5.10).
Eigen::Vector3d placeOf(const ChannelGaussian& g, const ChannelValue& value) {
    const Gaussian<4> joint = g.joint(value.channel);
    const Eigen::Vector3d cross = joint.covariance.topRightCorner<3, 1>();
    return joint.mean.head<3>() +
           cross * ((value.value - joint.mean[3]) / joint.covariance(3, 3));
}

/// Components that weigh most at a value, thesis eq. (5.9). Which of them are kept is
/// decided by the values of the other priors too, as far as the component holds them.
TopK likeliestAnywhere(const GroupPriors& priors, const ChannelValue& value) {
    const std::vector<float>& support = priors.group->mixture().places().support;
    std::array<const ValueIndex*, kMaxModalities> byValue{};
    for (std::size_t i = 0; i < priors.count; ++i)
        byValue[i] = &priors.group->byValue(priors.values[i].channel);
    TopK likeliest;
    for (const std::uint32_t k : priors.group->byValue(value.channel).at(value.value)) {
        double weight = std::log(double(support[k]));
        for (std::size_t i = 0; i < priors.count; ++i)
            weight += byValue[i]->logDensity(k, priors.values[i].value);
        likeliest.offer(weight, k);
    }
    return likeliest;
}

/// Candidate places L of thesis 5.2.2: from components around the point, if it is given and
/// something is known there, else from anywhere.
std::vector<Eigen::Vector3d> candidatePlaces(const std::vector<GroupPriors>& groups,
                                             const Eigen::Vector3d* point) {
    std::vector<Eigen::Vector3d> places;
    const auto collect = [&](bool around) {
        for (const GroupPriors& priors : groups)
            for (std::size_t i = 0; i < priors.count; ++i) {
                const ChannelValue& value = priors.values[i];
                for (const std::uint32_t k : around ? priors.group->likeliest(value, *point)
                                                    : likeliestAnywhere(priors, value))
                    places.push_back(placeOf(priors.group->mixture()[k], value));
            }
    };
    places.reserve(TopK::kMost * kMaxModalities);
    if (point != nullptr) collect(true);
    if (places.empty()) collect(false);
    return places;
}

}  // namespace

CrossModalEstimate inferModality(const ModalityMap& target,
                                 const std::vector<Prior>& priors,
                                 const Eigen::Vector3d* point) {
    const std::vector<GroupPriors> groups = byGroup(priors);
    CrossModalEstimate best;
    for (const Eigen::Vector3d& place : candidatePlaces(groups, point)) {
        double likelihood = 0;  // thesis eq. (5.12), (5.14)
        for (const GroupPriors& g : groups)
            likelihood += g.group->density(g.values.data(), g.count, place);
        if (best.known && !(likelihood > best.likelihood)) continue;
        const ModalityEstimate there = target.at(place);  // thesis eq. (5.13)
        if (there.known) best = {there.mean, there.variance, true, place, likelihood};
    }
    return best;
}

}  // namespace hgmm
