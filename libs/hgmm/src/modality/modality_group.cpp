#include "modality/modality_group.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "hgmm/divergence.h"
#include "hgmm/gaussian.h"
#include "hgmm/params.h"
#include "modality/channel_samples.h"
#include "modality/channel_sums.h"
#include "modality/linear_split.h"
#include "modality/modality_cache.h"
#include "scan/cells.h"

namespace hgmm {

namespace {

constexpr double kSmallestResidual = 1e-10;

/// The same component seen from another frame.
ChannelGaussian moved(ChannelGaussian g, const Pose& T_target_source) {
    const Eigen::Matrix3d& R = T_target_source.R;
    const Eigen::Matrix3d C = g.place.covariance;
    const Eigen::Vector3d mean = g.place.mean;
    g.place.mean = R * mean + T_target_source.t;
    g.place.covariance = R * C * R.transpose();
    for (ChannelFit& fit : g.fits) fit.slope = R * fit.slope;
    return g;
}

/// Means of samples, moved to another frame.
std::array<std::vector<float>, 3> movedMeans(const ChannelSamples& samples,
                                             const Pose& T_target_source) {
    std::array<std::vector<float>, 3> means = samples.mean();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d p =
            T_target_source.R * Eigen::Vector3d(means[0][i], means[1][i], means[2][i]) +
            T_target_source.t;
        for (int d = 0; d < 3; ++d) means[d][i] = static_cast<float>(p[d]);
    }
    return means;
}

/// Known samples by component, then novel ones by cell, both in order of first appearance.
std::vector<LinearRegion> regionsOf(const std::vector<std::uint32_t>& own,
                                    const std::array<std::vector<float>, 3>& means,
                                    const Eigen::Vector3d& sensorOrigin,
                                    const CellParams& params) {
    std::vector<LinearRegion> regions;
    regions.reserve(own.size() / 4 + 1);
    std::unordered_map<std::uint32_t, std::uint32_t> ofComponent;
    ofComponent.reserve(own.size() / 8);
    std::vector<std::uint32_t> novel;
    std::array<std::vector<float>, 3> novelMeans;
    for (std::uint32_t i = 0; i < own.size(); ++i) {
        if (own[i] == LinearRegion::kNone) {
            novel.push_back(i);
            for (int d = 0; d < 3; ++d) novelMeans[d].push_back(means[d][i]);
            continue;
        }
        const auto [entry, isNew] =
            ofComponent.try_emplace(own[i], static_cast<std::uint32_t>(regions.size()));
        if (isNew) {
            regions.emplace_back();
            regions.back().component = own[i];
        }
        regions[entry->second].samples.push_back(i);
    }
    const std::vector<LatticeCell> cells = assignCells(novelMeans, sensorOrigin, params);
    std::unordered_map<LatticeCell, std::uint32_t, LatticeCellHash> ofCell;
    for (std::size_t k = 0; k < novel.size(); ++k) {
        const auto [entry, isNew] =
            ofCell.try_emplace(cells[k], static_cast<std::uint32_t>(regions.size()));
        if (isNew) regions.emplace_back();
        regions[entry->second].samples.push_back(novel[k]);
    }
    return regions;
}

/// How much two components differ, as Agglomeration has it, for the channel where they do
/// most.
double difference(const ChannelGaussian& a, const ChannelGaussian& b, int channels) {
    double most = 0;
    for (int c = 0; c < channels; ++c) {
        const Gaussian<4> p = a.joint(c), q = b.joint(c);
        most = std::max(most, std::min(klDivergence(p, q), klDivergence(q, p)));
    }
    return most;
}

}  // namespace

std::vector<std::uint32_t> ModalityGroup::assignKnown(
    const std::array<std::vector<float>, 3>& means, double maxMahalanobis) const {
    const PlaceIndex& places = index();
    const auto maxSquared = static_cast<float>(maxMahalanobis * maxMahalanobis);
    std::vector<std::uint32_t> own(means[0].size(), LinearRegion::kNone);
    const auto n = static_cast<std::ptrdiff_t>(own.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        const float p[3] = {means[0][i], means[1][i], means[2][i]};
        float best = -std::numeric_limits<float>::infinity();
        places.components().visitCandidates(p[0], p[1], p[2], [&](std::uint32_t j) {
            const float peak = places.logPeak(j);
            // Most candidates are given up by this, many of the others by the first rows;
            // with a margin for rounding, so that the order of candidates never matters.
            const float bound = std::min(maxSquared, 2.F * (peak - best) + 1e-3F);
            if (bound < 0.F) return;
            const ComponentIndex::Factor& factor = places.components().factor(j);
            if (!factor.isWithin(p, bound)) return;
            const float weight = peak - 0.5F * factor.squaredMahalanobis(p);
            if (weight < best || (weight == best && j > own[i])) return;
            best = weight;
            own[i] = j;
        });
    }
    return own;
}

void ModalityGroup::insert(const ChannelSamples& samples, const Pose& T_local_sensor,
                           const MapParams& params) {
    if (samples.size() == 0) return;
    PlaceIndex& index = writableIndex();
    const auto means = movedMeans(samples, T_local_sensor);
    const auto own = assignKnown(means, params.novelty.maxMahalanobis);
    std::vector<LinearRegion> regions =
        regionsOf(own, means, T_local_sensor.t, params.cells);
    const Pose T_sensor_local = T_local_sensor.inverse();
    for (LinearRegion& region : regions)
        if (region.component != LinearRegion::kNone)
            region.prior = moved(mixture_[region.component], T_sensor_local);
    regions = splitWhereNotLinear(samples, std::move(regions), params.modality);
    for (const LinearRegion& region : regions) {
        ChannelSums sums(mixture_.channels());
        for (const std::uint32_t s : region.samples) sums.add(samples.sums(s));
        if (region.prior) sums.add(*region.prior);
        const ChannelGaussian component =
            moved(sums.gaussian(kSmallestResidual), T_local_sensor);
        auto i = region.component;
        if (i == LinearRegion::kNone) {
            i = static_cast<std::uint32_t>(mixture_.size());
            mixture_.pushBack(component);
        } else {
            mixture_.set(i, component);
        }
        index.update(mixture_.places(), i);
    }
    cache_->changed();
}

void ModalityGroup::merge(const ModalityGroup& other, const Pose& T_local_other,
                          const MapParams& params) {
    PlaceIndex& index = writableIndex();
    const std::size_t candidates = mixture_.size();
    const int channels = mixture_.channels();
    for (std::size_t k = 0; k < other.mixture_.size(); ++k) {
        const ChannelGaussian component = moved(other.mixture_[k], T_local_other);
        const Eigen::Vector3f mean = Eigen::Vector3d(component.place.mean).cast<float>();
        auto best = static_cast<std::uint32_t>(mixture_.size());
        double least = params.hierarchy.similarityMax;
        index.components().visitCandidates(
            mean.x(), mean.y(), mean.z(), [&](std::uint32_t j) {
                if (j >= candidates) return;
                const double d = difference(mixture_[j], component, channels);
                if (d > least || (d == least && j > best)) return;
                least = d;
                best = j;
            });
        if (best == mixture_.size()) {
            mixture_.pushBack(component);
        } else {
            // About the component itself: sums keep their digits far from the origin.
            const Pose toComponent{Eigen::Matrix3d::Identity(), -component.place.mean};
            ChannelSums sums(channels);
            sums.add(moved(mixture_[best], toComponent));
            sums.add(moved(component, toComponent));
            mixture_.set(best,
                         moved(sums.gaussian(kSmallestResidual), toComponent.inverse()));
        }
        index.update(mixture_.places(), best);
    }
    cache_->changed();
}

}  // namespace hgmm
