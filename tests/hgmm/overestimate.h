#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "hgmm/em.h"
#include "planted_mixture.h"

namespace hgmm::test {

/// A first guess of `size` components that knows nothing of how the samples came about, and
/// the neighbourhoods for fitSparse.
template <int D>
struct Overestimate {
    Mixture<D> mixture;
    Neighbourhoods neighbourhoods;
};

/// k-means++ seeding (Arthur and Vassilvitskii, SODA 2007): each centre is a sample drawn
/// with probability proportional to its squared distance from the centres so far.
template <int D>
std::vector<std::size_t> seedCentres(const Mixture<D>& samples, std::size_t size,
                                     std::mt19937_64& engine) {
    std::vector<double> distance(samples.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> centres{engine() % samples.size()};
    while (centres.size() < size) {
        double total = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            double d = 0;
            for (int a = 0; a < D; ++a) {
                const double gap = samples.mean[a][i] - samples.mean[a][centres.back()];
                d += gap * gap;
            }
            distance[i] = std::min(distance[i], d);
            total += distance[i];
        }
        double left = uniform(engine, 0, total);
        std::size_t i = 0;
        while (i + 1 < samples.size() && (left -= distance[i]) > 0) ++i;
        centres.push_back(i);
    }
    return centres;
}

/// Moments of the samples nearest to each centre; a sample's neighbourhood are the `reach`
/// nearest centres.
template <int D>
Overestimate<D> overestimate(const Mixture<D>& samples, std::size_t size, std::size_t reach,
                             std::mt19937_64& engine) {
    const std::vector<std::size_t> centres = seedCentres(samples, size, engine);
    std::vector<Gaussian<D>> cells(centres.size());
    Overestimate<D> out;
    out.neighbourhoods.begin.push_back(0);
    reach = std::min(reach, centres.size());
    std::vector<std::pair<float, std::uint32_t>> order(centres.size());
    std::vector<std::uint32_t> nearest(reach);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        for (std::size_t j = 0; j < centres.size(); ++j) {
            float d = 0;
            for (int a = 0; a < D; ++a) {
                const float gap = samples.mean[a][i] - samples.mean[a][centres[j]];
                d += gap * gap;
            }
            order[j] = {d, static_cast<std::uint32_t>(j)};
        }
        std::nth_element(order.begin(), order.begin() + (reach - 1), order.end());
        const auto home = std::min_element(order.begin(), order.begin() + reach)->second;
        const Gaussian<D> sample = samples[i];
        cells[home] = cells[home].support > 0 ? mergeMoments(cells[home], sample) : sample;
        for (std::size_t r = 0; r < reach; ++r) nearest[r] = order[r].second;
        std::sort(nearest.begin(), nearest.end());
        auto& component = out.neighbourhoods.component;
        component.insert(component.end(), nearest.begin(), nearest.end());
        out.neighbourhoods.begin.push_back(static_cast<std::uint32_t>(component.size()));
    }
    for (const Gaussian<D>& cell : cells) out.mixture.pushBack(cell);
    return out;
}

}  // namespace hgmm::test
