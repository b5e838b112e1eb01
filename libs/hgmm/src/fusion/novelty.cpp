#include "fusion/novelty.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hgmm/params.h"
#include "index/cell_order.h"
#include "index/within.h"

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

/// Of one chunk of samples, in no order.
struct Found {
    std::vector<Match> explained, oversized;
};

/// What explains the samples of a chunk.
class NoveltyTest {
 public:
    NoveltyTest(const CellOrder& samples, const ComponentIndex& index,
                const NoveltyParams& params, const SensorGeometry* geometry)
        : samples_(samples),
          index_(index),
          geometry_(geometry),
          maxSquared_(static_cast<float>(params.maxMahalanobis * params.maxMahalanobis)) {}

    Found find(std::size_t begin, std::size_t end) const {
        Found found;
        visitWithin(index_, samples_, begin, end, maxSquared_,
                    [&](std::size_t k, std::uint32_t j) { examine(k, j, found); });
        return found;
    }

 private:
    void examine(std::size_t k, std::uint32_t j, Found& found) const {
        const Match match{samples_.index[k], j};
        if (geometry_ == nullptr) return found.explained.push_back(match);
        const Eigen::Vector3d towardsSensor =
            geometry_->limit.sensorOrigin -
            Eigen::Vector3d(samples_.x[k], samples_.y[k], samples_.z[k]);
        // Sigma^-1 u is normal to the surface that the ray meets.
        const Factor& factor = index_.factor(j);
        const Eigen::Vector3d ray = whitened(factor, towardsSensor);
        const Eigen::Vector3d normal =
            geometry_->limit.inPlaneOfRays(transposed(factor, ray));
        const Eigen::Vector3d& view = geometry_->views[j].direction;
        if (normal.dot(view) <= 0 && !view.isZero()) return;
        const double maxVariance = geometry_->limit.maxVarianceAt(towardsSensor.norm());
        const bool isThin = ray.squaredNorm() <= maxVariance * normal.squaredNorm();
        (isThin ? found.explained : found.oversized).push_back(match);
    }

    const CellOrder& samples_;
    const ComponentIndex& index_;
    const SensorGeometry* geometry_;
    float maxSquared_;
};

std::vector<Match> explainedOf(const std::vector<Found>& found) {
    std::size_t count = 0;
    for (const Found& f : found) count += f.explained.size();
    std::vector<Match> explained;
    explained.reserve(count);
    for (const Found& f : found)
        explained.insert(explained.end(), f.explained.begin(), f.explained.end());
    return explained;
}

std::vector<NoveltySplit::Oversized> oversizedOf(const std::vector<Found>& found) {
    std::vector<NoveltySplit::Oversized> oversized;
    for (const Found& f : found)
        for (const Match& m : f.oversized) oversized.push_back({m.component, m.point});
    std::sort(oversized.begin(), oversized.end(), [](const auto& a, const auto& b) {
        return a.sample != b.sample ? a.sample < b.sample : a.component < b.component;
    });
    return oversized;
}

}  // namespace

NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params, const SensorGeometry* geometry) {
    const CellOrder order =
        orderedByCells(samples.mean[0].data(), samples.mean[1].data(),
                       samples.mean[2].data(), samples.size(), index.smallestOctave());
    const NoveltyTest test(order, index, params, geometry);
    const std::size_t chunks = (samples.size() + kSamplesPerChunk - 1) / kSamplesPerChunk;
    std::vector<Found> found(chunks);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t c = 0; c < chunks; ++c)
        found[c] = test.find(c * kSamplesPerChunk,
                             std::min(samples.size(), (c + 1) * kSamplesPerChunk));

    Neighbourhoods all = neighbourhoodsOf(explainedOf(found), samples.size());
    NoveltySplit split;
    split.neighbourhoods.begin.push_back(0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::uint32_t first = all.begin[i], last = all.begin[i + 1];
        if (first == last) {
            split.novel.push_back(static_cast<std::uint32_t>(i));
            continue;
        }
        split.known.push_back(static_cast<std::uint32_t>(i));
        split.neighbourhoods.begin.push_back(last);
    }
    // Samples without components take no room.
    split.neighbourhoods.component = std::move(all.component);
    split.oversized = oversizedOf(found);
    return split;
}

Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices) {
    Mixture<3> rows;
    rows.reserve(indices.size());
    for (const std::uint32_t i : indices) rows.pushBack(mixture[i]);
    return rows;
}

}  // namespace hgmm
