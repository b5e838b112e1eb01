#include "fusion/novelty.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/simd.h"
#include "hgmm/params.h"
#include "index/cell_order.h"

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

/// Factor::isWithin of four points: -1 or 0 each, and the same sums.
Int4 isWithin(const Factor& factor, const CellOrder& points, std::size_t k,
              float maxSquared) {
    Float4 x, y, z;
    std::memcpy(&x, points.x.data() + k, sizeof(x));
    std::memcpy(&y, points.y.data() + k, sizeof(y));
    std::memcpy(&z, points.z.data() + k, sizeof(z));
    x -= factor.mean(0), y -= factor.mean(1), z -= factor.mean(2);
    const Float4 a = factor.factor(0, 0) * x;
    const Float4 b = factor.factor(1, 0) * x + factor.factor(1, 1) * y;
    const Float4 c =
        factor.factor(2, 0) * x + factor.factor(2, 1) * y + factor.factor(2, 2) * z;
    return a * a + b * b + c * c <= maxSquared;
}

struct Match {
    std::uint32_t sample, component;
};

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
        index_.visitCandidates(samples_, begin, end,
                               [&](std::uint32_t j, std::size_t first, std::size_t last) {
                                   for (std::size_t k = first; k < last; k += 4) {
                                       const Int4 within = isWithin(
                                           index_.factor(j), samples_, k, maxSquared_);
                                       const std::size_t lanes =
                                           std::min<std::size_t>(4, last - k);
                                       for (std::size_t lane = 0; lane < lanes; ++lane)
                                           if (within[lane] != 0)
                                               examine(k + lane, j, found);
                                   }
                               });
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

/// Components by sample, rising.
Neighbourhoods bySample(const std::vector<Found>& found, std::size_t samples) {
    Neighbourhoods all;
    all.begin.assign(samples + 1, 0);
    for (const Found& f : found)
        for (const Match& m : f.explained) ++all.begin[m.sample + 1];
    for (std::size_t i = 0; i < samples; ++i) all.begin[i + 1] += all.begin[i];
    all.component.resize(all.begin[samples]);
    std::vector<std::uint32_t> next(all.begin.begin(), all.begin.end() - 1);
    for (const Found& f : found)
        for (const Match& m : f.explained) all.component[next[m.sample]++] = m.component;
    for (std::size_t i = 0; i < samples; ++i)
        std::sort(all.component.begin() + all.begin[i],
                  all.component.begin() + all.begin[i + 1]);
    return all;
}

std::vector<NoveltySplit::Oversized> oversizedOf(const std::vector<Found>& found) {
    std::vector<NoveltySplit::Oversized> oversized;
    for (const Found& f : found)
        for (const Match& m : f.oversized) oversized.push_back({m.component, m.sample});
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

    Neighbourhoods all = bySample(found, samples.size());
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
