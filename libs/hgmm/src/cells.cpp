#include "hgmm/cells.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "hgmm/component_index.h"
#include "hgmm/require.h"
#include "hgmm/thickness.h"

namespace hgmm {

namespace {

/// A cell too empty to be a component joins its parent at most this often.
constexpr int kMaxPromotions = 2;

/// Samples see components up to this distance in the E-step [sigma]: the far corner of a
/// touching cell of evenly spread samples lies at 3 sqrt(3) = 5.2.
constexpr float kNeighbourSigmas = 6.F;

/// Each sample's own component and the others whose ellipsoid it is in.
Neighbourhoods findNeighbourhoods(const Mixture<3>& samples, const Mixture<3>& mixture,
                                  const std::vector<std::uint32_t>& own) {
    ComponentIndex index(kNeighbourSigmas);
    index.rebuild(mixture);
    Neighbourhoods result;
    result.begin.push_back(0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const float p[3] = {samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]};
        const auto first = static_cast<std::ptrdiff_t>(result.component.size());
        result.component.push_back(own[i]);
        index.visitCandidates(p[0], p[1], p[2], [&](std::uint32_t j) {
            if (j != own[i] &&
                index.factor(j).isWithin(p, kNeighbourSigmas * kNeighbourSigmas))
                result.component.push_back(j);
        });
        std::sort(result.component.begin() + first, result.component.end());
        result.begin.push_back(static_cast<std::uint32_t>(result.component.size()));
    }
    return result;
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
                                            const Thinning& thinning) {
    const std::optional<Cut> cut = cutOf(whole.moments, thinning.limit);
    if (!cut) return std::nullopt;
    std::pair<Part, Part> sides;
    for (const std::uint32_t i : whole.samples) {
        const Gaussian<3> sample = samples[i];
        const bool isAbove = cut->normal.dot(sample.mean) > cut->offset;
        (isAbove ? sides.second : sides.first).add(i, sample);
    }
    for (const Part& side : {sides.first, sides.second})
        if (side.samples.empty() || side.moments.support < thinning.minSupport)
            return std::nullopt;
    return sides;
}

/// Appends what is left of a part when all that is too thick is cut.
void cutUntilThin(Part whole, const Mixture<3>& samples, const Thinning& thinning,
                  std::vector<Part>& thin) {
    if (auto sides = halves(whole, samples, thinning)) {
        cutUntilThin(std::move(sides->first), samples, thinning, thin);
        cutUntilThin(std::move(sides->second), samples, thinning, thin);
    } else {
        thin.push_back(std::move(whole));
    }
}

/// The components of doubled cells with samples that are learnt again, by their numbers.
std::map<std::uint32_t, Part> doubledAgain(const Mixture<3>& samples,
                                           const std::vector<LatticeCell>& cells,
                                           const Thinning& thinning,
                                           const std::vector<Gaussian<3>>& components,
                                           const std::vector<std::uint32_t>& own) {
    std::map<std::uint32_t, Part> doubled;
    for (const std::uint32_t i : thinning.again) {
        const double range = (samples[i].mean - thinning.limit.sensorOrigin).norm();
        // Others hold as many samples as they must, and are hardly ever too thick.
        if (cells[i].octave > octaveOf(thinning.limit.cells.edgeAt(range)))
            doubled[own[i]].moments = components[own[i]];
    }
    if (doubled.empty()) return doubled;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (const auto part = doubled.find(own[i]); part != doubled.end())
            part->second.samples.push_back(static_cast<std::uint32_t>(i));
    return doubled;
}

/// Cuts those of them that are thicker than the limit.
/// @param cells of the samples
/// @param own component of each sample
void cutThick(const Mixture<3>& samples, const std::vector<LatticeCell>& cells,
              const Thinning& thinning, std::vector<Gaussian<3>>& components,
              std::vector<std::uint32_t>& own) {
    for (auto& [c, whole] : doubledAgain(samples, cells, thinning, components, own)) {
        std::vector<Part> thin;
        cutUntilThin(std::move(whole), samples, thinning, thin);
        components[c] = thin[0].moments;
        for (std::size_t k = 1; k < thin.size(); ++k) {
            for (const std::uint32_t i : thin[k].samples)
                own[i] = static_cast<std::uint32_t>(components.size());
            components.push_back(thin[k].moments);
        }
    }
}

}  // namespace

void CellParams::validate() const {
    requireInRange("cellAtOneMetre_m", cellAtOneMetre_m, 1e-3, 100.0);
    requireInRange("minCell_m", minCell_m, 1e-3, 1e3);
    requireInRange("minSamples", minSamples, 1, 1e6);
}

std::vector<LatticeCell> assignCells(const std::array<std::vector<float>, 3>& means,
                                     const Eigen::Vector3d& sensorOrigin,
                                     const CellParams& params) {
    std::vector<LatticeCell> cells(means[0].size());
    std::unordered_map<LatticeCell, int, LatticeCellHash> count;
    for (std::size_t i = 0; i < means[0].size(); ++i) {
        const Eigen::Vector3d p(means[0][i], means[1][i], means[2][i]);
        cells[i] = LatticeCell::at(p, octaveOf(params.edgeAt((p - sensorOrigin).norm())));
        ++count[cells[i]];
    }
    for (int promotion = 0; promotion < kMaxPromotions; ++promotion) {
        std::unordered_map<LatticeCell, int, LatticeCellHash> next;
        for (std::size_t i = 0; i < means[0].size(); ++i) {
            if (count[cells[i]] < params.minSamples) cells[i] = cells[i].parent();
            ++next[cells[i]];
        }
        count = std::move(next);
    }
    return cells;
}

InitialMixture initialiseFromCells(const Mixture<3>& samples,
                                   const Eigen::Vector3d& sensorOrigin,
                                   const CellParams& params, const Thinning* thinning) {
    const std::vector<LatticeCell> cells = assignCells(samples.mean, sensorOrigin, params);
    std::unordered_map<LatticeCell, std::uint32_t, LatticeCellHash> componentOf;
    std::vector<std::uint32_t> own(samples.size());
    std::vector<Gaussian<3>> components;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto [entry, isNew] =
            componentOf.emplace(cells[i], static_cast<std::uint32_t>(components.size()));
        own[i] = entry->second;
        if (isNew)
            components.push_back(samples[i]);
        else
            components[own[i]] = mergeMoments(components[own[i]], samples[i]);
    }
    if (thinning != nullptr) cutThick(samples, cells, *thinning, components, own);
    InitialMixture initial;
    initial.mixture.reserve(components.size());
    for (const Gaussian<3>& c : components) initial.mixture.pushBack(c);
    initial.neighbourhoods = findNeighbourhoods(samples, initial.mixture, own);
    return initial;
}

}  // namespace hgmm
