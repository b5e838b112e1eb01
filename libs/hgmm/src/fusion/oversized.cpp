#include "fusion/oversized.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/portable_math.h"
#include "base/power_of_two.h"
#include "fusion/novelty.h"
#include "fusion/responsibilities.h"

namespace hgmm {

namespace {

/// Support of a sample that falls to a component.
struct Share {
    std::uint32_t component;
    double support;
};

/// What oversized components would be given of the samples, components rising.
std::vector<Share> oversizedShares(const Mixture<3>& mixture, const ComponentIndex& index,
                                   const Mixture<3>& samples, const NoveltySplit& split) {
    std::vector<Share> shares;
    std::vector<double> p;
    std::size_t k = 0;  // of the known samples, the next one
    for (std::size_t begin = 0, end; begin < split.oversized.size(); begin = end) {
        const std::uint32_t i = split.oversized[begin].sample;
        for (end = begin; end < split.oversized.size() && split.oversized[end].sample == i;)
            ++end;
        const float point[3] = {samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]};
        const auto add = [&](std::uint32_t j) {
            p.push_back(portable::log(double(mixture.support[j])) +
                        index.factor(j).logPdf(point));
        };
        p.clear();
        for (std::size_t o = begin; o < end; ++o) add(split.oversized[o].component);
        while (k < split.known.size() && split.known[k] < i) ++k;
        if (k < split.known.size() && split.known[k] == i)
            for (std::uint32_t e = split.neighbourhoods.begin[k];
                 e < split.neighbourhoods.begin[k + 1]; ++e)
                add(split.neighbourhoods.component[e]);
        normalise(p);
        for (std::size_t o = begin; o < end; ++o)
            shares.push_back(
                {split.oversized[o].component, p[o - begin] * samples.support[i]});
    }
    std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
        return a.component < b.component;
    });
    return shares;
}

/// The plane across which a component is to be cut.
struct Cut {
    Eigen::Vector3d normal;
    double offset;
};

/// Nothing if the component is as thin as it must be.
std::optional<Cut> cutOf(const Gaussian<3>& component, const ThicknessLimit& limit) {
    const Eigen::LLT<Eigen::Matrix3d> llt(component.covariance);
    if (llt.info() != Eigen::Success) return std::nullopt;
    const Eigen::Vector3d towardsSensor = limit.sensorOrigin - component.mean,
                          solved = llt.solve(towardsSensor),
                          normal = limit.inPlaneOfRays(solved);
    if (!(towardsSensor.dot(solved) >
          limit.maxVarianceAt(towardsSensor.norm()) * normal.squaredNorm()))
        return std::nullopt;
    return Cut{normal, normal.dot(component.mean)};
}

/// Some of the samples, and their moments.
struct Part {
    Gaussian<3> moments;
    std::vector<std::uint32_t> samples;

    void add(std::uint32_t i, const Gaussian<3>& sample) {
        moments = samples.empty() ? sample : mergeMoments(moments, sample);
        samples.push_back(i);
    }
};

/// Both sides, unless one would have too little support.
std::optional<std::pair<Part, Part>> halves(const Part& whole, const Mixture<3>& samples,
                                            const SplitPolicy& policy) {
    const std::optional<Cut> cut = cutOf(whole.moments, policy.limit);
    if (!cut) return std::nullopt;
    std::pair<Part, Part> sides;
    for (const std::uint32_t i : whole.samples) {
        const Gaussian<3> sample = samples[i];
        const bool isAbove = cut->normal.dot(sample.mean) > cut->offset;
        (isAbove ? sides.second : sides.first).add(i, sample);
    }
    for (const Part& side : {sides.first, sides.second})
        if (side.samples.empty() || side.moments.support < policy.minSupport)
            return std::nullopt;
    return sides;
}

/// Appends what is left of a part when all that is too thick is cut.
void cutUntilThin(Part whole, const Mixture<3>& samples, const SplitPolicy& policy,
                  std::vector<Part>& thin) {
    if (auto sides = halves(whole, samples, policy)) {
        cutUntilThin(std::move(sides->first), samples, policy, thin);
        cutUntilThin(std::move(sides->second), samples, policy, thin);
    } else {
        thin.push_back(std::move(whole));
    }
}

/// The components of doubled cells with relearned samples, by their numbers.
std::map<std::uint32_t, Part> relearnedDoubledCells(const Mixture<3>& samples,
                                                    const CellMoments& guess,
                                                    const SplitPolicy& policy) {
    std::map<std::uint32_t, Part> doubled;
    for (const std::uint32_t i : policy.relearned) {
        const double range = (samples[i].mean - policy.limit.sensorOrigin).norm();
        // Others hold as many samples as they must, and are hardly ever too thick.
        if (guess.cellOf[i].octave > octaveOf(policy.limit.cells.edgeAt(range))) {
            const std::uint32_t c = guess.componentOf[i];
            doubled[c].moments = guess.components[c];
        }
    }
    if (doubled.empty()) return doubled;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (const auto part = doubled.find(guess.componentOf[i]); part != doubled.end())
            part->second.samples.push_back(static_cast<std::uint32_t>(i));
    return doubled;
}

}  // namespace

double ThicknessLimit::maxVarianceAt(double range_m) const {
    const double thickness = maxThickness * cells.edgeAt(range_m),
                 noise = filter.noiseAt(range_m);
    return thickness * thickness + noise * noise;
}

std::vector<SupportDecay> downweightOversized(const Mixture<3>& mixture,
                                              const ComponentIndex& index,
                                              const Mixture<3>& samples,
                                              const NoveltySplit& split) {
    const std::vector<Share> shares = oversizedShares(mixture, index, samples, split);
    std::vector<SupportDecay> decays;
    for (std::size_t s = 0; s < shares.size();) {
        const std::uint32_t j = shares[s].component;
        double lost = 0;
        for (; s < shares.size() && shares[s].component == j; ++s)
            lost += shares[s].support;
        const float before = mixture.support[j],
                    after = std::max(static_cast<float>(before - lost), kNoSupport);
        if (after < before) decays.push_back({j, after});
    }
    return decays;
}

std::vector<std::uint32_t> relearned(const NoveltySplit& split) {
    std::vector<std::uint32_t> result;
    auto oversized = split.oversized.begin();
    for (std::uint32_t n = 0; n < split.novel.size(); ++n) {
        while (oversized != split.oversized.end() && oversized->sample < split.novel[n])
            ++oversized;
        if (oversized == split.oversized.end()) break;
        if (oversized->sample == split.novel[n]) result.push_back(n);
    }
    return result;
}

void splitOversized(const Mixture<3>& samples, const SplitPolicy& policy,
                    CellMoments& guess) {
    for (auto& [c, whole] : relearnedDoubledCells(samples, guess, policy)) {
        std::vector<Part> thin;
        cutUntilThin(std::move(whole), samples, policy, thin);
        guess.components[c] = thin[0].moments;
        for (std::size_t k = 1; k < thin.size(); ++k) {
            for (const std::uint32_t i : thin[k].samples)
                guess.componentOf[i] = static_cast<std::uint32_t>(guess.components.size());
            guess.components.push_back(thin[k].moments);
        }
    }
}

}  // namespace hgmm
