#include "fusion/novelty.h"

#include <algorithm>
#include <cmath>

#include "hgmm/params.h"

namespace hgmm {

namespace {

/// Samples handled by one task: fixed, so that results do not depend on the number of
/// threads.
constexpr std::size_t kSamplesPerChunk = 256;

using Factor = ComponentIndex::Factor;

/// W v: in standard deviations of the component.
Eigen::Vector3d whitened(const Factor& factor, const Eigen::Vector3d& v) {
    Eigen::Vector3d w = Eigen::Vector3d::Zero();
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col <= row; ++col)
            w[row] += double(factor.factor(row, col)) * v[col];
    return w;
}

/// W^T w.
Eigen::Vector3d transposed(const Factor& factor, const Eigen::Vector3d& w) {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col <= row; ++col)
            v[col] += double(factor.factor(row, col)) * w[row];
    return v;
}

struct Found {
    Neighbourhoods neighbourhoods;
    std::vector<NoveltySplit::Oversized> oversized;
};

/// What explains one sample after the other.
class NoveltyTest {
 public:
    NoveltyTest(const Mixture<3>& samples, const ComponentIndex& index,
                const NoveltyParams& params, const SensorGeometry* geometry)
        : samples_(samples),
          index_(index),
          geometry_(geometry),
          maxSquared_(static_cast<float>(params.maxMahalanobis * params.maxMahalanobis)) {}

    void find(std::size_t i, Found& found) const {
        const float point[3] = {samples_.mean[0][i], samples_.mean[1][i],
                                samples_.mean[2][i]};
        Eigen::Vector3d towardsSensor = Eigen::Vector3d::Zero();
        double maxVariance = 0;
        if (geometry_ != nullptr) {
            towardsSensor = geometry_->limit.sensorOrigin -
                            Eigen::Vector3d(point[0], point[1], point[2]);
            maxVariance = geometry_->limit.maxVarianceAt(towardsSensor.norm());
        }
        auto& components = found.neighbourhoods.component;
        const auto first = static_cast<std::ptrdiff_t>(components.size()),
                   firstOversized = static_cast<std::ptrdiff_t>(found.oversized.size());
        index_.visitCandidates(point[0], point[1], point[2], [&](std::uint32_t j) {
            const Factor& factor = index_.factor(j);
            if (!factor.isWithin(point, maxSquared_)) return;
            if (geometry_ != nullptr) {
                // Sigma^-1 u is normal to the surface that the ray meets.
                const Eigen::Vector3d ray = whitened(factor, towardsSensor);
                const Eigen::Vector3d normal =
                    geometry_->limit.inPlaneOfRays(transposed(factor, ray));
                const Eigen::Vector3d& view = geometry_->views[j].direction;
                if (normal.dot(view) <= 0 && !view.isZero()) return;
                if (ray.squaredNorm() > maxVariance * normal.squaredNorm()) {
                    found.oversized.push_back({j, static_cast<std::uint32_t>(i)});
                    return;
                }
            }
            components.push_back(j);
        });
        std::sort(components.begin() + first, components.end());
        std::sort(found.oversized.begin() + firstOversized, found.oversized.end(),
                  [](const NoveltySplit::Oversized& a, const NoveltySplit::Oversized& b) {
                      return a.component < b.component;
                  });
        found.neighbourhoods.begin.push_back(static_cast<std::uint32_t>(components.size()));
    }

 private:
    const Mixture<3>& samples_;
    const ComponentIndex& index_;
    const SensorGeometry* geometry_;
    float maxSquared_;
};

}  // namespace

NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params, const SensorGeometry* geometry) {
    const NoveltyTest explanation(samples, index, params, geometry);
    const std::size_t chunks = (samples.size() + kSamplesPerChunk - 1) / kSamplesPerChunk;
    std::vector<Found> found(chunks);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t c = 0; c < chunks; ++c) {
        found[c].neighbourhoods.begin.push_back(0);
        const std::size_t end = std::min(samples.size(), (c + 1) * kSamplesPerChunk);
        for (std::size_t i = c * kSamplesPerChunk; i < end; ++i)
            explanation.find(i, found[c]);
    }

    NoveltySplit split;
    split.neighbourhoods.begin.push_back(0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Neighbourhoods& n = found[i / kSamplesPerChunk].neighbourhoods;
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
    for (const Found& f : found)
        split.oversized.insert(split.oversized.end(), f.oversized.begin(),
                               f.oversized.end());
    return split;
}

Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices) {
    Mixture<3> rows;
    rows.reserve(indices.size());
    for (const std::uint32_t i : indices) rows.pushBack(mixture[i]);
    return rows;
}

}  // namespace hgmm
