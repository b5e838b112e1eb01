#include "occupancy/occupancy_model.h"

#include <algorithm>
#include <cmath>

#include "base/dual.h"
#include "base/normal_mass.h"
#include "hgmm/params.h"

namespace hgmm {

namespace {

constexpr double kSqrtTwoPi = 2.5066282746310002;

constexpr double kSigmas = OccupancyModel::kSigmas;
const double kCutDensity = std::exp(-0.5 * kSigmas * kSigmas);

template <typename T>
T square(const T& v) {
    return v * v;
}

/// A relative density that reaches zero where the index ends, so that nothing jumps there.
template <typename T>
T tapered(const T& density) {
    return valueOf(density) > kCutDensity ? density - kCutDensity : T(0.0);
}

BoxIndex::Box boxAround(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& halfExtent) {
    BoxIndex::Box box;
    for (int d = 0; d < 3; ++d) {
        box.centre[d] = static_cast<float>((a[d] + b[d]) / 2);
        box.halfExtent[d] = static_cast<float>(std::abs(a[d] - b[d]) / 2 + halfExtent[d]);
    }
    return box;
}

template <int D>
Eigen::Vector3d ellipsoidExtent(const Gaussian<D>& g) {
    return kSigmas *
           Eigen::Vector3d(g.covariance.diagonal().template head<3>()).cwiseSqrt();
}

float peakOf(double support, double logNormalizer) {
    return static_cast<float>(std::min(support * std::exp(logNormalizer), 1e30));
}

}  // namespace

OccupancyModel::OccupancyModel(const OccupancyParams& params)
    : params_(params),
      unknownDensity_(std::exp(-0.5 * square(params.knownSigmas))),
      sharpness_(square(params.knownSigmas / params.extentSigmas)) {
    params.validate();
}

OccupancyModel::Joint OccupancyModel::jointOf(const Gaussian<4>& g) {
    Gaussian<3> place;
    place.mean = g.mean.head<3>();
    place.covariance = g.covariance.topLeftCorner<3, 3>();
    const RegressedGaussian<4> regressed(g, 1.0);
    Joint joint;
    joint.place = WhitenedGaussian<3, float>(place);
    for (int d = 0; d < 3; ++d) joint.slope[d] = static_cast<float>(regressed.slope(d));
    joint.meanW_m = static_cast<float>(g.mean[3]);
    joint.varianceW_m2 = static_cast<float>(regressed.variance());
    joint.peak = peakOf(g.support, joint.place.logNormalizer());
    return joint;
}

void OccupancyModel::updateSurface(std::uint32_t i, const Gaussian<3>& surface,
                                   const ViewDirection& view) {
    Band band;
    band.whitened = WhitenedGaussian<3, float>(surface);
    band.peak = peakOf(surface.support, band.whitened.logNormalizer());
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col <= row; ++col)
            band.v[row] +=
                band.whitened.factor(row, col) * static_cast<float>(view.direction[col]);
    for (const float v : band.v) band.viewPrecision += v * v;
    band.width_m = static_cast<float>(params_.band.width(view.range_m));
    band.reach_m = static_cast<float>(params_.band.reach(view.range_m));
    band.freePerMetre = static_cast<float>(params_.band.freePerMetre(view.range_m));

    if (i == bands_.size()) bands_.emplace_back();
    bands_.at(i) = band;
    const Eigen::Vector3d extent = ellipsoidExtent(surface);
    extents_.resize(bands_.size());
    extents_[i] = boxAround(surface.mean, surface.mean, extent);
    bounds_.reset();
    surfaceBoxes_.update(i, extents_[i]);
    const Eigen::Vector3d end =
        surface.mean + (view.known() ? band.reach_m : 0.F) * view.direction;
    bandBoxes_.update(i, boxAround(surface.mean, end, extent));
}

void OccupancyModel::truncateSurfaces(std::size_t n) {
    bandBoxes_.truncate(n);
    surfaceBoxes_.truncate(n);
    if (bands_.size() <= n) return;
    bands_.resize(n);
    extents_.resize(n);
    bounds_.reset();
}

void OccupancyModel::updateFree(std::uint32_t i, const Gaussian<4>& component) {
    if (i == freeJoints_.size()) freeJoints_.emplace_back();
    freeJoints_.at(i) = jointOf(component);
    const Eigen::Vector3d mean = component.mean.head<3>();
    freeBoxes_.update(i, boxAround(mean, mean, ellipsoidExtent(component)));
}

template <typename T>
void OccupancyModel::addBand(const Band& band, const T* x, Sums<T>& sums) const {
    using std::exp;
    T whitened[3];
    for (int row = 0; row < 3; ++row) {
        whitened[row] = 0.0;
        for (int col = 0; col <= row; ++col)
            whitened[row] += double(band.whitened.factor(row, col)) *
                             (x[col] - double(band.whitened.mean(col)));
    }
    const T squared = square(whitened[0]) + square(whitened[1]) + square(whitened[2]);
    const double precision = band.viewPrecision;
    if (precision == 0.0) {
        if (valueOf(squared) > kSigmas * kSigmas) return;
        const T density = exp(-0.5 * squared);
        sums.occupied += double(band.peak) * density;
        sums.known += tapered(density);
        return;
    }
    const T along = double(band.v[0]) * whitened[0] + double(band.v[1]) * whitened[1] +
                    double(band.v[2]) * whitened[2];
    const T beside = squared - along * along / precision;
    if (valueOf(beside) > kSigmas * kSigmas) return;

    // Along the view a hit is N(t; 0, tau^2), t being the height of x over the surface.
    const double tau = 1.0 / std::sqrt(precision), reach = band.reach_m;
    const T t = along / precision;
    const T column = exp(-0.5 * beside);
    const T hit = exp(-0.5 * precision * t * t);
    const T low = -1.0 * t / tau, high = (reach - t) / tau;
    const T mass = normalMass(low, high);
    const T fall = valueOf(t) > band.width_m ? double(band.width_m) / t : T(1.0);
    const T occupied = double(band.peak) * column * hit;
    const T free = double(band.peak) * column * mass *
                   (tau * kSqrtTwoPi * double(band.freePerMetre)) * fall;
    sums.occupied += occupied;
    sums.free += free;
    const T outside = valueOf(t) < 0 ? t : valueOf(t) > reach ? t - reach : T(0.0);
    sums.known +=
        tapered(exp(-0.5 * (sharpness_ * beside + precision * outside * outside)));

    // W is 0 for hits, and N(t, tau^2) cut to [0, reach] for free points.
    const double z = valueOf(mass), a = valueOf(low), b = valueOf(high);
    if (!(z > 1e-12)) return;
    const double pa = std::exp(-0.5 * a * a) / kSqrtTwoPi;
    const double pb = std::exp(-0.5 * b * b) / kSqrtTwoPi;
    const double shift = (pa - pb) / z;
    const double mean = valueOf(t) + tau * shift;
    const double variance =
        std::max(0.0, tau * tau * (1 + (a * pa - b * pb) / z - shift * shift));
    sums.distance += valueOf(free) * mean;
    sums.squaredDistance += valueOf(free) * (mean * mean + variance);
}

template <typename T>
void OccupancyModel::addFree(const Joint& joint, const T* x, Sums<T>& sums) const {
    using std::exp;
    T offset[3], squared = 0.0, meanW = double(joint.meanW_m);
    for (int d = 0; d < 3; ++d) {
        offset[d] = x[d] - double(joint.place.mean(d));
        meanW += double(joint.slope[d]) * offset[d];
    }
    for (int row = 0; row < 3; ++row) {
        T whitened = 0.0;
        for (int col = 0; col <= row; ++col)
            whitened += double(joint.place.factor(row, col)) * offset[col];
        squared += whitened * whitened;
    }
    if (valueOf(squared) > kSigmas * kSigmas) return;
    const T relative = exp(-0.5 * squared);
    const T density = double(joint.peak) * relative;
    sums.known += tapered(exp(-0.5 * sharpness_ * squared));
    sums.free += density;
    const double m = valueOf(meanW), weight = valueOf(density);
    sums.distance += weight * m;
    sums.squaredDistance += weight * (m * m + double(joint.varianceW_m2));
}

template <typename T>
OccupancyModel::Sums<T> OccupancyModel::sums(const T* x) const {
    const float p[3] = {static_cast<float>(valueOf(x[0])),
                        static_cast<float>(valueOf(x[1])),
                        static_cast<float>(valueOf(x[2]))};
    Sums<T> sums;
    bandBoxes_.visitCandidates(p[0], p[1], p[2],
                               [&](std::uint32_t i) { addBand(bands_[i], x, sums); });
    freeBoxes_.visitCandidates(p[0], p[1], p[2],
                               [&](std::uint32_t i) { addFree(freeJoints_[i], x, sums); });
    return sums;
}

Occupancy OccupancyModel::at(const Eigen::Vector3d& point) const {
    Occupancy answer;
    if (!point.allFinite()) return answer;
    const Sums<double> s = sums(point.data());
    const double total = s.occupied + s.free;
    if (!(total > 1e-300)) return answer;
    const double seen = s.known / (s.known + unknownDensity_) / total;
    // thesis eq. (4.15), (4.16)
    answer.occupied = static_cast<float>(std::clamp(s.occupied * seen, 0.0, 1.0));
    answer.free = std::min(static_cast<float>(std::clamp(s.free * seen, 0.0, 1.0)),
                           1.F - answer.occupied);
    answer.unknown = std::max(0.F, 1.F - answer.occupied - answer.free);
    const double mean = s.distance / total;  // thesis eq. (4.17)
    answer.distance_m = static_cast<float>(mean);
    answer.variance_m2 = static_cast<float>(
        std::max(0.0, s.squaredDistance / total - mean * mean));  // thesis eq. (4.18)
    return answer;
}

Eigen::Vector3d OccupancyModel::gradient(const Eigen::Vector3d& point) const {
    if (!point.allFinite()) return Eigen::Vector3d::Zero();
    const Dual x[3] = {{point.x(), Eigen::Vector3d::UnitX()},
                       {point.y(), Eigen::Vector3d::UnitY()},
                       {point.z(), Eigen::Vector3d::UnitZ()}};
    const Sums<Dual> s = sums(x);
    const Dual total = s.occupied + s.free;
    if (!(total.value > 1e-300)) return Eigen::Vector3d::Zero();
    const Dual occupied = s.occupied / total * s.known / (s.known + unknownDensity_);
    return occupied.gradient.allFinite() ? occupied.gradient
                                         : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

std::size_t OccupancyModel::liveBytes() const {
    return bands_.capacity() * sizeof(Band) + freeJoints_.capacity() * sizeof(Joint) +
           extents_.capacity() * sizeof(BoxIndex::Box) + bandBoxes_.liveBytes() +
           surfaceBoxes_.liveBytes() + freeBoxes_.liveBytes();
}

}  // namespace hgmm
