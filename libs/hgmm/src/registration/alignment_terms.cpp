#include "registration/alignment_terms.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "registration/grazing_samples.h"

namespace hgmm {

namespace {

/// Patches farther than so many deviations are not looked for.
constexpr double kReachDeviations = 3.0;
/// Surfaces and samples are no more exact than this [m].
constexpr double kLeastStd_m = 0.005;
/// The kernel is no narrower than so many standard deviations of a pair.
constexpr double kNarrowestKernel = 3.0;
/// A patch is no place beside a narrower kernel [m].
constexpr double kLeastPlace_m = 0.1;
/// Samples that one thread sums at a time.
constexpr std::size_t kSamplesPerSum = 128;

std::array<float, 3> toPoint(const Eigen::Vector3d& p) {
    return {float(p.x()), float(p.y()), float(p.z())};
}

/// How far a patch holds a sample along an axis, from 0 to 1. Across a rectangle, as far as
/// its normal is known: one that is as thick as it is wide, such as what a ring of a lidar
/// drew, may face anywhere about its length. Beside a kernel that is wider than it, it is
/// but a place, which leads samples to it. What a planar laser drew is a line in its plane,
/// and holds across both of its thin axes.
double holdAlong(const SurfacePatch<3>& patch, int axis, bool planar, double kernel_m) {
    const double width_m = double(patch.halfEdge[1]), length_m = double(patch.halfEdge[2]);
    if (!(length_m > 0.0)) return 0.0;
    if (planar) {
        constexpr double line = 1.0 / 8, strip = 1.0 / 4;
        return axis == 0
                   ? 1.0
                   : std::clamp((strip - width_m / length_m) / (strip - line), 0.0, 1.0);
    }
    if (axis > 0) return 0.0;
    if (kernel_m > std::max(width_m, kLeastPlace_m)) return 1.0;
    const double thickness_m = kPatchSigmas * double(patch.normalStd_m);
    return width_m > thickness_m ? 1.0 - thickness_m / width_m : 0.0;
}

struct PlacedSample {
    Eigen::Vector3d arm;  ///< from the sensor, in the target's axes [m]
    Eigen::Vector3d point;
    Eigen::Matrix3d covariance;
    bool planar;   ///< of a planar laser
    bool grazing;  ///< areGrazing
};

PlacedSample placed(const AlignmentSamples& samples, std::size_t i, const Pose& T) {
    const Eigen::Vector3d arm = T.R * samples.mean[i];
    return {arm, arm + T.t, T.R * samples.covariance[i] * T.R.transpose(), samples.planar,
            samples.grazing[i]};
}

/// Adds the terms of one pair; returns their gradient.
Vector6d addPair(const SurfacePatch<3>& patch, const PlacedSample& sample,
                 float squaredDistance_m2, double kernel_m, AlignmentSums& sums) {
    const Eigen::Map<const Eigen::Vector3f> mean(patch.mean.data());
    const Eigen::Vector3d offset = sample.point - mean.cast<double>();
    Vector6d gradient = Vector6d::Zero();
    for (int a = 0; a < 2; ++a) {
        const double hold = holdAlong(patch, a, sample.planar, kernel_m);
        if (!(hold > 0.0)) continue;
        const Eigen::Map<const Eigen::Vector3f> axis(patch.axes[a].data());
        const Eigen::Vector3d n = axis.cast<double>();
        if (sample.grazing &&
            std::abs(n.dot(sample.arm)) > kGrazingSine * sample.arm.norm())
            continue;
        const double std_m =
            a == 0 ? double(patch.normalStd_m) : double(patch.halfEdge[a]) / kPatchSigmas;
        const double variance_m2 =
            std_m * std_m + n.dot(sample.covariance * n) + kLeastStd_m * kLeastStd_m;
        const double width2 =
            kernel_m * kernel_m + kNarrowestKernel * kNarrowestKernel * variance_m2;
        const double robust = 1.0 + double(squaredDistance_m2) / width2;
        const double weight = hold / (robust * robust);
        Vector6d jacobian;
        jacobian << sample.arm.cross(n), n;
        const double perVariance = weight / variance_m2;
        const double distance_m = n.dot(offset);
        gradient += (perVariance * distance_m) * jacobian;
        sums.information.noalias() += perVariance * jacobian * jacobian.transpose();
        sums.facing.noalias() += weight * jacobian * jacobian.transpose();
        if (a == 0) {
            sums.weight += weight;
            if (double(squaredDistance_m2) <
                kNarrowestKernel * kNarrowestKernel * variance_m2)
                sums.nearby += 1.0;
        }
    }
    sums.gradient += gradient;
    return gradient;
}

}  // namespace

AlignmentSums& AlignmentSums::operator+=(const AlignmentSums& o) {
    gradient += o.gradient;
    information += o.information;
    facing += o.facing;
    weight += o.weight;
    nearby += o.nearby;
    return *this;
}

std::vector<SamplePair> pairWithPatches(const PatchTree<3>& target,
                                        const AlignmentSamples& samples, const Pose& T,
                                        const SearchRadius& deviation,
                                        const std::vector<SamplePair>& before) {
    std::vector<SamplePair> pairs(samples.size());
    const auto n = static_cast<std::int64_t>(samples.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < n; ++k) {
        const auto i = static_cast<std::size_t>(k);
        const double range_m = samples.mean[i].norm();
        const auto nearest =
            target.nearest(toPoint(T.R * samples.mean[i] + T.t),
                           static_cast<float>(kReachDeviations * deviation.at(range_m)),
                           before.empty() ? SurfaceDistance::kNone : before[i].slot);
        if (nearest.component == SurfaceDistance::kNone) continue;
        pairs[i] = {nearest.slot, nearest.squaredDistance_m2};
    }
    return pairs;
}

AlignmentSums sumTerms(const PatchTree<3>& target, const AlignmentSamples& samples,
                       const std::vector<SamplePair>& pairs, const Pose& T,
                       const SearchRadius& kernel) {
    const std::size_t chunks = (samples.size() + kSamplesPerSum - 1) / kSamplesPerSum;
    std::vector<AlignmentSums> parts(chunks);
#pragma omp parallel for schedule(static)
    for (std::int64_t c = 0; c < static_cast<std::int64_t>(chunks); ++c) {
        const auto chunk = static_cast<std::size_t>(c);
        const std::size_t end = std::min((chunk + 1) * kSamplesPerSum, samples.size());
        for (std::size_t i = chunk * kSamplesPerSum; i < end; ++i) {
            if (pairs[i].slot == SurfaceDistance::kNone) continue;
            addPair(target.patch(pairs[i].slot), placed(samples, i, T),
                    pairs[i].squaredDistance_m2, kernel.at(samples.mean[i].norm()),
                    parts[chunk]);
        }
    }
    AlignmentSums sums;
    for (const AlignmentSums& part : parts) sums += part;
    return sums;
}

Matrix6d scatterByPatch(const PatchTree<3>& target, const AlignmentSamples& samples,
                        const std::vector<SamplePair>& pairs, const Pose& T,
                        const SearchRadius& kernel) {
    std::vector<std::pair<std::uint32_t, std::size_t>> bySlot;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].slot != SurfaceDistance::kNone) bySlot.emplace_back(pairs[i].slot, i);
    std::sort(bySlot.begin(), bySlot.end());
    Matrix6d scatter = Matrix6d::Zero();
    AlignmentSums unused;
    for (std::size_t k = 0; k < bySlot.size();) {
        const std::uint32_t slot = bySlot[k].first;
        Vector6d gradient = Vector6d::Zero();
        for (; k < bySlot.size() && bySlot[k].first == slot; ++k) {
            const std::size_t i = bySlot[k].second;
            gradient += addPair(target.patch(slot), placed(samples, i, T),
                                pairs[i].squaredDistance_m2,
                                kernel.at(samples.mean[i].norm()), unused);
        }
        scatter += gradient * gradient.transpose();
    }
    return scatter;
}

}  // namespace hgmm
