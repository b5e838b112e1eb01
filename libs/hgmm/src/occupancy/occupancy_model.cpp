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
/// Of points that rays passed and that no component answers for [1/m^3].
constexpr double kPassedDensity = 0.05;
/// A tile of a surface, evenly filled, ends at sqrt(3) sigma.
constexpr double kTileSigmas2 = 3.0;
/// Cells of coverage reach at most this far past a surface, in edges at its range: some
/// were marked from farther away.
constexpr double kSideCells = 1.5;
/// Whether space is open behind a surface is looked up this far behind it, in those
/// reaches.
constexpr double kBeyond = 1.3;
const double kCutDensity = std::exp(-0.5 * kSigmas * kSigmas);

template <typename T>
T square(const T& v) {
    return v * v;
}

/// 0 up to `low`, 1 from `high` on, linear between.
template <typename T>
T ramp(const T& v, double low, double high) {
    if (!(valueOf(v) > low)) return 0.0;
    if (!(valueOf(v) < high)) return 1.0;
    return (v - low) / (high - low);
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

OccupancyModel::OccupancyModel(const OccupancyParams& params, const Coverage& coverage)
    : params_(params),
      coverage_(coverage),
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
    for (int d = 0; d < 3; ++d) band.view[d] = static_cast<float>(view.direction[d]);
    band.side_m = static_cast<float>(kSideCells * params_.coverage.edgeAt(view.range_m));
    band.freePerMetre = static_cast<float>(params_.band.freePerMetre(view.range_m));

    if (i == bands_.size()) bands_.emplace_back();
    bands_.at(i) = band;
    const Eigen::Vector3d front = (view.known() ? band.reach_m : 0.F) * view.direction;
    const Eigen::Vector3d back = (view.known() ? -band.side_m : 0.F) * view.direction;
    boxes_.resize(bands_.size());
    boxes_[i] =
        boxAround(surface.mean + back, surface.mean + front, ellipsoidExtent(surface));
    bandBoxes_.update(i, boxes_[i]);
    bounds_.reset();
}

void OccupancyModel::truncateSurfaces(std::size_t n) {
    bandBoxes_.truncate(n);
    if (bands_.size() <= n) return;
    bands_.resize(n);
    boxes_.resize(n);
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
    const T free = double(band.peak) * column * mass *
                   (tau * kSqrtTwoPi * double(band.freePerMetre)) * fall;
    sums.occupied += double(band.peak) * column * hit;
    sums.known += tapered(exp(-0.5 * sharpness_ * beside) * hit);
    addSide(band, t, beside, sums.sides);

    // W is 0 for hits, and N(t, tau^2) cut to [0, reach] for free points.
    const double z = valueOf(mass), a = valueOf(low), b = valueOf(high);
    double meanW = 0, squaredW = 0;
    if (z > 1e-12) {
        const double pa = std::exp(-0.5 * a * a) / kSqrtTwoPi;
        const double pb = std::exp(-0.5 * b * b) / kSqrtTwoPi;
        const double shift = (pa - pb) / z;
        meanW = valueOf(t) + tau * shift;
        squaredW = square(meanW) +
                   square(tau) * std::max(0.0, 1 + (a * pa - b * pb) / z - square(shift));
    }
    sums.atHits.add(free * hit, meanW, squaredW);
    sums.passed.add(free * (1.0 - hit), meanW, squaredW);
}

template <typename T>
void OccupancyModel::addSide(const Band& band, const T& height, const T& beside,
                             Sides<T>& sides) const {
    const bool isFront = valueOf(height) > 0;
    const double tau = 1.0 / std::sqrt(double(band.viewPrecision)), end = band.side_m;
    const T distance = isFront ? height : -1.0 * height;
    const T over = 1.0 - ramp(beside, kTileSigmas2, square(params_.extentSigmas));
    const T side =
        over * ramp(distance, tau, 2 * tau) * (1.0 - ramp(distance, 0.8 * end, end));
    if (!(valueOf(side) > 0)) return;
    if (isFront) return sides.addFront(side);
    double beyond[3];
    for (int d = 0; d < 3; ++d)
        beyond[d] = double(band.whitened.mean(d)) - kBeyond * end * double(band.view[d]);
    sides.addBehind(side, band.view, coverage_.at(beyond));
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
    const double m = valueOf(meanW);
    sums.passed.add(double(joint.peak) * exp(-0.5 * squared), m,
                    m * m + double(joint.varianceW_m2));
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

template <typename T>
OccupancyModel::Answer<T> OccupancyModel::answer(const T* x) const {
    Answer<T> answer;
    const Sums<T> s = sums(x);
    const T coverage = coverage_.at(x) * (1.0 - s.sides.shadow());
    const T free = s.atHits.density + coverage * (s.passed.density + kPassedDensity);
    const T total = s.occupied + free;
    if (!(valueOf(total) > 1e-300)) return answer;
    const T known = 1.0 - unknownDensity_ / (s.known + unknownDensity_) * (1.0 - coverage);
    answer.occupied = s.occupied / total * known;  // thesis eq. (4.15)
    answer.free = free / total * known;            // thesis eq. (4.16)

    const double c = valueOf(coverage);
    const double weight =
        valueOf(s.occupied) + valueOf(s.atHits.density) + c * valueOf(s.passed.density);
    if (!(weight > 1e-300)) return answer;
    answer.alongRay_m =  // thesis eq. (4.17)
        (s.atHits.distance + c * s.passed.distance) / weight;
    answer.variance_m2 =  // thesis eq. (4.18)
        std::max(0.0, (s.atHits.squaredDistance + c * s.passed.squaredDistance) / weight -
                          square(answer.alongRay_m));
    return answer;
}

Occupancy OccupancyModel::at(const Eigen::Vector3d& point) const {
    Occupancy result;
    if (!point.allFinite()) return result;
    const Answer<double> a = answer(point.data());
    result.occupied = static_cast<float>(std::clamp(a.occupied, 0.0, 1.0));
    result.free =
        std::min(static_cast<float>(std::clamp(a.free, 0.0, 1.0)), 1.F - result.occupied);
    result.unknown = std::max(0.F, 1.F - result.occupied - result.free);
    result.alongRay_m = static_cast<float>(a.alongRay_m);
    result.variance_m2 = static_cast<float>(a.variance_m2);
    return result;
}

Eigen::Vector3d OccupancyModel::gradient(const Eigen::Vector3d& point) const {
    if (!point.allFinite()) return Eigen::Vector3d::Zero();
    const Dual x[3] = {{point.x(), Eigen::Vector3d::UnitX()},
                       {point.y(), Eigen::Vector3d::UnitY()},
                       {point.z(), Eigen::Vector3d::UnitZ()}};
    const Dual occupied = answer(x).occupied;
    return occupied.gradient.allFinite() ? occupied.gradient
                                         : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

std::size_t OccupancyModel::liveBytes() const {
    return bands_.capacity() * sizeof(Band) + freeJoints_.capacity() * sizeof(Joint) +
           boxes_.capacity() * sizeof(BoxIndex::Box) + bandBoxes_.liveBytes() +
           freeBoxes_.liveBytes();
}

}  // namespace hgmm
