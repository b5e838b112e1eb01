#include "hgmm/novelty.h"

#include <algorithm>
#include <utility>

#include "hgmm/require.h"

namespace hgmm {

namespace {

/// Samples handled by one task: fixed, so that results do not depend on the number of
/// threads.
constexpr std::size_t kSamplesPerChunk = 256;

/// Whether a component was seen from the side of `direction` (towards a sensor).
bool sameSide(const ComponentIndex::Factor& factor, const Eigen::Vector3d& view,
              const Eigen::Vector3d& direction) {
    double product = 0;
    for (int row = 0; row < 3; ++row) {
        double a = 0, b = 0;
        for (int col = 0; col <= row; ++col) {
            a += double(factor.factor(row, col)) * view[col];
            b += double(factor.factor(row, col)) * direction[col];
        }
        product += a * b;
    }
    return product > 0 || view.isZero();
}

void findNeighbours(const Mixture<3>& samples, std::size_t begin, std::size_t end,
                    const ComponentIndex& index, float maxSquared, const Sides* sides,
                    Neighbourhoods& found) {
    for (std::size_t i = begin; i < end; ++i) {
        const float point[3] = {samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]};
        const std::size_t first = found.component.size();
        Eigen::Vector3d towardsSensor = Eigen::Vector3d::Zero();
        if (sides != nullptr)
            towardsSensor =
                sides->sensorOrigin - Eigen::Vector3d(point[0], point[1], point[2]);
        index.visitCandidates(point[0], point[1], point[2], [&](std::uint32_t j) {
            const ComponentIndex::Factor& factor = index.factor(j);
            if (!factor.isWithin(point, maxSquared)) return;
            if (sides != nullptr &&
                !sameSide(factor, sides->views[j].direction, towardsSensor))
                return;
            found.component.push_back(j);
        });
        std::sort(found.component.begin() + static_cast<std::ptrdiff_t>(first),
                  found.component.end());
        found.begin.push_back(static_cast<std::uint32_t>(found.component.size()));
    }
}

}  // namespace

void NoveltyParams::validate() const {
    requireInRange("maxMahalanobis", maxMahalanobis, 0.1, ComponentIndex::kSigmas);
}

NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params, const Sides* sides) {
    const auto maxSquared =
        static_cast<float>(params.maxMahalanobis * params.maxMahalanobis);
    const std::size_t chunks = (samples.size() + kSamplesPerChunk - 1) / kSamplesPerChunk;
    std::vector<Neighbourhoods> found(chunks);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t c = 0; c < chunks; ++c) {
        found[c].begin.push_back(0);
        findNeighbours(samples, c * kSamplesPerChunk,
                       std::min(samples.size(), (c + 1) * kSamplesPerChunk), index,
                       maxSquared, sides, found[c]);
    }

    NoveltySplit split;
    split.neighbourhoods.begin.push_back(0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Neighbourhoods& n = found[i / kSamplesPerChunk];
        const std::uint32_t first = n.begin[i % kSamplesPerChunk],
                            last = n.begin[i % kSamplesPerChunk + 1];
        if (first == last) {
            split.novel.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        split.known.push_back(static_cast<std::uint32_t>(i));
        auto& all = split.neighbourhoods.component;
        all.insert(all.end(), n.component.begin() + first, n.component.begin() + last);
        split.neighbourhoods.begin.push_back(static_cast<std::uint32_t>(all.size()));
    }
    return split;
}

Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices) {
    Mixture<3> rows;
    rows.reserve(indices.size());
    for (const std::uint32_t i : indices) rows.pushBack(mixture[i]);
    return rows;
}

}  // namespace hgmm
