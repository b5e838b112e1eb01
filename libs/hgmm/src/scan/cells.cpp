#include "scan/cells.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "index/within.h"

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
    const CellOrder order =
        orderedByCells(samples.mean[0].data(), samples.mean[1].data(),
                       samples.mean[2].data(), samples.size(), index.smallestOctave());
    std::vector<Match> matches;
    for (std::uint32_t i = 0; i < samples.size(); ++i) matches.push_back({i, own[i]});
    visitWithin(index, order, 0, order.size(), kNeighbourSigmas * kNeighbourSigmas,
                [&](std::size_t k, std::uint32_t j) {
                    if (j != own[order.index[k]]) matches.push_back({order.index[k], j});
                });
    return neighbourhoodsOf(matches, samples.size());
}

}  // namespace

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

CellMoments momentsOfCells(const Mixture<3>& samples, const Eigen::Vector3d& sensorOrigin,
                           const CellParams& params) {
    CellMoments result;
    result.cellOf = assignCells(samples.mean, sensorOrigin, params);
    std::unordered_map<LatticeCell, std::uint32_t, LatticeCellHash> componentOf;
    result.componentOf.resize(samples.size());
    std::vector<Gaussian<3>>& components = result.components;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto [entry, isNew] = componentOf.emplace(
            result.cellOf[i], static_cast<std::uint32_t>(components.size()));
        const std::uint32_t c = result.componentOf[i] = entry->second;
        if (isNew)
            components.push_back(samples[i]);
        else
            components[c] = mergeMoments(components[c], samples[i]);
    }
    return result;
}

InitialMixture initialMixture(const Mixture<3>& samples, const CellMoments& guess) {
    InitialMixture initial;
    initial.mixture.reserve(guess.components.size());
    for (const Gaussian<3>& c : guess.components) initial.mixture.pushBack(c);
    initial.neighbourhoods =
        findNeighbourhoods(samples, initial.mixture, guess.componentOf);
    return initial;
}

InitialMixture initialiseFromCells(const Mixture<3>& samples,
                                   const Eigen::Vector3d& sensorOrigin,
                                   const CellParams& params) {
    return initialMixture(samples, momentsOfCells(samples, sensorOrigin, params));
}

}  // namespace hgmm
