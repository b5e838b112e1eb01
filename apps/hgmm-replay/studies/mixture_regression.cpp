#include "studies/mixture_regression.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "hgmm/em.h"
#include "hgmm/hierarchy.h"

namespace replay {
namespace {

using Mixture2 = hgmm::Mixture<2>;

/// One component per cell over x and y, of the smallest size that CellParams allows.
Mixture2 smallestCells(const Mixture2& samples) {
    hgmm::Mixture<3> flat;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        hgmm::Gaussian<3> sample;
        sample.support = samples.support[i];
        sample.mean << samples[i].mean, 0.0;
        flat.pushBack(sample);
    }
    hgmm::CellParams params;
    params.cellAtOneMetre_m = 1e-3;
    const hgmm::Mixture<3> cells =
        hgmm::initialiseFromCells(flat, Eigen::Vector3d::Zero(), params).mixture;
    Mixture2 mixture;
    for (std::size_t j = 0; j < cells.size(); ++j) {
        const hgmm::Gaussian<3> cell = cells[j];
        hgmm::Gaussian<2> g;
        g.support = cell.support;
        g.mean = cell.mean.head<2>();
        g.covariance = cell.covariance.topLeftCorner<2, 2>();
        mixture.pushBack(g);
    }
    return mixture;
}

/// The moments of `count` cells over x with equally many samples, but for one.
Mixture2 cellsOverX(const Mixture2& samples, std::size_t count) {
    std::vector<std::size_t> order(samples.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return samples.mean[0][a] < samples.mean[0][b];
    });
    Mixture2 cells;
    for (std::size_t c = 0; c < count; ++c) {
        const std::size_t first = c * order.size() / count;
        const std::size_t last = (c + 1) * order.size() / count;
        hgmm::Gaussian<2> cell = samples[order[first]];
        for (std::size_t i = first + 1; i < last; ++i)
            cell = hgmm::mergeMoments(cell, samples[order[i]]);
        cells.pushBack(cell);
    }
    return cells;
}

/// The first `own` samples see the component of their number only, the others see all.
hgmm::Neighbourhoods neighbourhoods(std::size_t own, std::size_t others) {
    hgmm::Neighbourhoods n;
    n.begin.push_back(0);
    const auto components = static_cast<std::uint32_t>(own);
    const auto close = [&n] {
        n.begin.push_back(static_cast<std::uint32_t>(n.component.size()));
    };
    for (std::uint32_t j = 0; j < components; ++j) {
        n.component.push_back(j);
        close();
    }
    for (std::size_t i = 0; i < others; ++i) {
        for (std::uint32_t j = 0; j < components; ++j) n.component.push_back(j);
        close();
    }
    return n;
}

}  // namespace

MixtureRegression::MixtureRegression(const Mixture2& firstSet) {
    if (firstSet.empty()) throw std::invalid_argument("MixtureRegression: no samples");
    const hgmm::EmParams em;
    const Mixture2 reference =
        hgmm::fitDense(firstSet, smallestCells(firstSet), em).mixture;
    overestimate_ = reference.size();
    const std::size_t size =
        hgmm::generateHierarchy(reference, hgmm::HierarchyParams{}).levels.front().size();
    mixture_ = hgmm::fitDense(firstSet, cellsOverX(firstSet, size), em).mixture;
}

void MixtureRegression::update(const Mixture2& set) {
    // A component is the sum of its statistics S_pi, S_mu, S_Sigma. Taken as a sample that
    // belongs to it alone, it adds just these to the M-step: one iteration of EM is then
    // thesis eq. (3.19) to (3.22).
    Mixture2 samples = mixture_;
    samples.append(set);
    hgmm::EmParams once;
    once.maxIterations = 1;
    mixture_ = hgmm::fitSparse(samples, mixture_,
                               neighbourhoods(mixture_.size(), set.size()), once)
                   .mixture;
}

}  // namespace replay
