#include "studies/batch_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

namespace replay {
namespace {

/// As far as the first guess of a scan's mixture lets samples see.
constexpr double kNeighbourSigmas = 6;

constexpr int kRounds = 3;              ///< of finding neighbourhoods
constexpr int kIterationsPerRound = 5;  ///< of EM

/// Two parts of a Gaussian as of an even spread that is cut in the middle of its longest
/// axis: centres sqrt(3)/2 sigma away from it, a quarter of the variance each.
std::pair<hgmm::Gaussian<3>, hgmm::Gaussian<3>> halves(const hgmm::Gaussian<3>& whole) {
    const Eigen::Matrix3d covariance = whole.covariance;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
    const Eigen::Vector3d offset =
        std::sqrt(0.75 * std::max(0.0, axes.eigenvalues()[2])) * axes.eigenvectors().col(2);
    hgmm::Gaussian<3> one = whole;
    one.support = 0.5 * whole.support;
    one.covariance = covariance - offset * offset.transpose();
    hgmm::Gaussian<3> other = one;
    one.mean = whole.mean - offset;
    other.mean = whole.mean + offset;
    return {one, other};
}

}  // namespace

hgmm::Mixture<3> batchGuess(const SamplePool& pool, std::size_t size,
                            const hgmm::HierarchyParams& params) {
    SamplePool cells = pool;
    for (SamplePool next = cells.coarser(); next.size() >= size && next.size() > 1;
         next = cells.coarser())
        cells = std::move(next);
    return hgmm::mergeToSize(cells.samples(), size, params);
}

hgmm::Mixture<3> splitToSize(const hgmm::Mixture<3>& mixture, std::size_t size) {
    std::vector<hgmm::Gaussian<3>> parts;
    for (std::size_t j = 0; j < mixture.size(); ++j) parts.push_back(mixture[j]);
    // Most support first; of equals, the first component.
    const auto later = [&](std::size_t a, std::size_t b) {
        return parts[a].support < parts[b].support ||
               (parts[a].support == parts[b].support && a > b);
    };
    std::priority_queue<std::size_t, std::vector<std::size_t>, decltype(later)> queue(
        later);
    for (std::size_t j = 0; j < parts.size(); ++j) queue.push(j);
    while (!queue.empty() && parts.size() < size) {
        const std::size_t j = queue.top();
        queue.pop();
        const auto [one, other] = halves(parts[j]);
        parts[j] = one;
        parts.push_back(other);
        queue.push(j);
        queue.push(parts.size() - 1);
    }
    hgmm::Mixture<3> result;
    for (const hgmm::Gaussian<3>& part : parts) result.pushBack(part);
    return result;
}

hgmm::Mixture<3> batchFit(const hgmm::Mixture<3>& samples, const hgmm::Mixture<3>& initial,
                          std::size_t size) {
    hgmm::Mixture<3> mixture = initial;
    for (int round = 0; round < kRounds; ++round) {
        mixture = splitToSize(mixture, size);
        mixture =
            hgmm::fitSparse(samples, mixture,
                            hgmm::neighbourhoodsOf(samples.mean, mixture, kNeighbourSigmas),
                            {kIterationsPerRound, 0.0})
                .mixture;
    }
    return mixture;
}

}  // namespace replay
