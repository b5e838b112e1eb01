#include <algorithm>
#include <cmath>

#include "base/dual.h"
#include "base/normal_mass.h"
#include "occupancy/band_kernels.h"
#include "occupancy/occupancy_model.h"

namespace hgmm {

namespace {

constexpr double kSqrtTwoPi = 2.5066282746310002;
/// A tile of a surface, evenly filled, ends at sqrt(3) sigma.
constexpr double kTileSigmas2 = 3.0;
/// Whether space is open behind a surface is looked up this far behind it, in those
/// reaches.
constexpr double kBeyond = 1.3;

/// 0 up to `low`, 1 from `high` on, linear between.
template <typename T>
T ramp(const T& v, double low, double high) {
    if (!(valueOf(v) > low)) return 0.0;
    if (!(valueOf(v) < high)) return 1.0;
    return (v - low) / (high - low);
}

/// A relative density that reaches zero where the index ends, so that nothing jumps there.
template <typename T>
T tapered(const T& density, double cut) {
    return valueOf(density) > cut ? density - cut : T(0.0);
}

float squaredNorm(const std::array<float, 3>& v) {
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

bool isInside(const BoxCells::Box& box, const float* point) {
    // Without branches: three tests cost less than one that is guessed wrong.
    bool inside = true;
    for (int d = 0; d < 3; ++d)
        inside &= std::abs(point[d] - box.centre[d]) <= box.halfExtent[d];
    return inside;
}

}  // namespace

Eigen::Vector3d OccupancyModel::beyond(const OccupancyParams& params,
                                       const Gaussian<3>& surface,
                                       const ViewDirection& view) {
    return surface.mean - kBeyond * double(sideReach_m(params, view)) * view.direction;
}

double OccupancyModel::coverageBeyond(std::uint32_t i) const {
    const ViewDirection view = surfaces_.views[i];
    const double beyond_m = kBeyond * double(sideReach_m(params_, view));
    double beyond[3];
    for (int d = 0; d < 3; ++d)
        beyond[d] = double(surfaces_.rows.mean[d][i]) - beyond_m * view.direction[d];
    return coverage_.at(beyond);
}

template <typename T>
auto OccupancyModel::sideOf(std::uint32_t i, float viewPrecision, const T& height,
                            const T& beside) const -> Side<T> {
    Side<T> side;
    side.isFront = valueOf(height) > 0;
    const double tau = 1.0 / std::sqrt(double(viewPrecision));
    const T distance = side.isFront ? height : -1.0 * height;
    const T over = 1.0 - ramp(beside, kTileSigmas2, square(params_.extentSigmas));
    const T off = over * ramp(distance, tau, 2 * tau);
    if (!(valueOf(off) > 0)) return side;
    const double end = sideReach_m(params_, surfaces_.views[i]);
    side.share = off * (1.0 - ramp(distance, 0.8 * end, end));
    return side;
}
template auto OccupancyModel::sideOf(std::uint32_t, float, const double&,
                                     const double&) const -> Side<double>;

template <typename T>
void OccupancyModel::addSide(std::uint32_t i, const Side<T>& side, Sides<T>& sides) const {
    if (!(valueOf(side.share) > 0)) return;
    if (side.isFront)
        sides.addFront(side.share);
    else
        sides.addBehind(side.share, viewOf(i), coverageBeyond(i));
}

std::array<float, 3> OccupancyModel::viewOf(std::uint32_t i) const {
    const ViewDirection view = surfaces_.views[i];
    std::array<float, 3> direction{};
    for (int d = 0; d < 3; ++d) direction[d] = static_cast<float>(view.direction[d]);
    return direction;
}

void OccupancyModel::addBand(std::uint32_t i, const Dual* x, Sums<Dual>& sums) const {
    const Factor& factor = surfaces_.index.factor(i);
    const std::array<float, 3> view = whitenedView(i);
    const Band band = bandOf(i, squaredNorm(view));
    Dual whitened[3];
    for (int row = 0; row < 3; ++row) {
        whitened[row] = 0.0;
        for (int col = 0; col <= row; ++col)
            whitened[row] +=
                double(factor.factor(row, col)) * (x[col] - double(factor.mean(col)));
    }
    const Dual squared = square(whitened[0]) + square(whitened[1]) + square(whitened[2]);
    const double precision = band.viewPrecision;
    if (precision == 0.0) {
        if (valueOf(squared) > kReach2) return;
        const Dual density = exp(-0.5 * squared);
        sums.occupied += double(band.peak) * density;
        sums.known += tapered(density, kCutDensity);
        return;
    }
    const Dual along = double(view[0]) * whitened[0] + double(view[1]) * whitened[1] +
                       double(view[2]) * whitened[2];
    const Dual beside = squared - along * along / precision;
    if (valueOf(beside) > kReach2) return;

    // Along the view a hit is N(t; 0, tau^2), t being the height of x over the surface.
    const double tau = 1.0 / std::sqrt(precision), reach = band.reach_m;
    const Dual t = along / precision;
    const Dual column = exp(-0.5 * beside);
    const Dual hit = exp(-0.5 * precision * t * t);
    const Dual low = -1.0 * t / tau, high = (reach - t) / tau;
    const Dual mass = normalMass(low, high);
    const Dual fall = valueOf(t) > band.width_m ? double(band.width_m) / t : Dual(1.0);
    const Dual free = double(band.peak) * column * mass *
                      (tau * kSqrtTwoPi * double(band.freePerMetre)) * fall;
    sums.occupied += double(band.peak) * column * hit;
    sums.known += tapered(exp(-0.5 * sharpness_ * beside) * hit, kCutDensity);
    addSide(i, sideOf(i, band.viewPrecision, t, beside), sums.sides);

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

void OccupancyModel::addFree(const Joint& joint, const Dual* x, Sums<Dual>& sums) const {
    Dual offset[3], squared = 0.0, meanW = double(joint.meanW_m);
    for (int d = 0; d < 3; ++d) {
        offset[d] = x[d] - double(joint.place.mean(d));
        meanW += double(joint.slope[d]) * offset[d];
    }
    for (int row = 0; row < 3; ++row) {
        Dual whitened = 0.0;
        for (int col = 0; col <= row; ++col)
            whitened += double(joint.place.factor(row, col)) * offset[col];
        squared += whitened * whitened;
    }
    if (valueOf(squared) > kReach2) return;
    const double m = valueOf(meanW);
    sums.passed.add(double(joint.peak) * exp(-0.5 * squared), m,
                    m * m + double(joint.varianceW_m2));
}

OccupancyModel::Sums<Dual> OccupancyModel::sums(const Dual* x) const {
    const float point[3] = {static_cast<float>(x[0].value), static_cast<float>(x[1].value),
                            static_cast<float>(x[2].value)};
    Sums<Dual> sums;
    bandBoxes_.visitCandidates(point[0], point[1], point[2], [&](std::uint32_t i) {
        if (isInside(boxes_[i], point)) addBand(i, x, sums);
    });
    freeBoxes_.visitCandidates(point[0], point[1], point[2],
                               [&](std::uint32_t i) { addFree(freeJoints_[i], x, sums); });
    return sums;
}

OccupancyModel::Sums<double> OccupancyModel::sums(const double* x) const {
    float point[3], rest[3];
    for (int d = 0; d < 3; ++d) {
        point[d] = static_cast<float>(x[d]);
        rest[d] = static_cast<float>(x[d] - double(point[d]));
    }
    Sums<double> sums;
    std::uint32_t ids[bands::kBlock];
    int n = 0;
    bandBoxes_.visitCandidates(point[0], point[1], point[2], [&](std::uint32_t i) {
        ids[n] = i;
        n += int(isInside(boxes_[i], point));
        if (n < bands::kBlock) return;
        addBands(ids, n, point, rest, sums);
        n = 0;
    });
    addBands(ids, n, point, rest, sums);

    alignas(32) float squared[bands::kBlock] = {};
    n = 0;
    freeBoxes_.visitCandidates(point[0], point[1], point[2], [&](std::uint32_t i) {
        ids[n] = i;
        squared[n] = freeJoints_[i].place.squaredMahalanobis(point);
        n += int(squared[n] <= float(kReach2));
        if (n < bands::kBlock) return;
        addFree(ids, squared, n, x, sums);
        n = 0;
    });
    addFree(ids, squared, n, x, sums);
    return sums;
}

/// The densities of thesis eq. (4.15) and (4.16), integrated over W in closed form.
void OccupancyModel::addBands(const std::uint32_t* ids, int n, const float* point,
                              const float* rest, Sums<double>& sums) const {
    // Of the thread: they are large, and what is left of the last time does no harm.
    static thread_local bands::Lanes near{}, felt{};
    static thread_local bands::Places places{};
    static thread_local bands::Densities densities{};
    float viewPrecision[bands::kBlock];
    for (int k = 0; k < n; ++k) viewPrecision[k] = gatherPlace(ids[k], near, k);
    bands::kernel().place(near, n, point, rest, places);

    std::uint32_t feltIds[bands::kBlock];
    int count = 0;
    for (int k = 0; k < n; ++k) {
        if (!(places.beside[k] <= float(kReach2))) continue;
        places.beside[count] = places.beside[k];
        places.height[count] = places.height[k];
        viewPrecision[count] = viewPrecision[k];
        gatherBand(bandOf(ids[k], viewPrecision[k]), felt, count);
        feltIds[count++] = ids[k];
    }
    bands::kernel().evaluate(felt, places, count, float(kCutDensity), densities);
    for (int k = 0; k < count; ++k) {
        addDensities(densities, k, sums);
        addSide(feltIds[k],
                sideOf(feltIds[k], viewPrecision[k], double(places.height[k]),
                       double(places.beside[k])),
                sums.sides);
    }
}

void OccupancyModel::addDensities(const bands::Densities& densities, int k,
                                  Sums<double>& sums) {
    const double meanW = densities.meanW[k], squaredW = densities.meanSquaredW[k];
    sums.occupied += double(densities.occupied[k]);
    sums.known += double(densities.known[k]);
    sums.atHits.add(double(densities.freeAtHits[k]), meanW, squaredW);
    sums.passed.add(double(densities.freePassed[k]), meanW, squaredW);
}

/// What bands::Kernel::place reads. Returns |v|^2 of the view.
float OccupancyModel::gatherPlace(std::uint32_t i, bands::Lanes& lanes, int k) const {
    const Factor& factor = surfaces_.index.factor(i);
    for (int d = 0; d < 3; ++d) lanes.mean[d][k] = factor.mean(d);
    for (int row = 0, entry = 0; row < 3; ++row)
        for (int col = 0; col <= row; ++col)
            lanes.factor[entry++][k] = factor.factor(row, col);
    const std::array<float, 3> v = whitenedView(i);
    for (int d = 0; d < 3; ++d) lanes.view[d][k] = v[d];
    const float precision = squaredNorm(v);
    lanes.precision[k] = precision > 0 ? precision : 1.F;
    return precision;
}

/// What bands::Kernel::evaluate reads. Without a view all of the distance is beside.
void OccupancyModel::gatherBand(const Band& band, bands::Lanes& lanes, int k) const {
    lanes.tau[k] = band.hasView() ? band.tau_m : 1.F;
    lanes.sharpness[k] = band.hasView() ? static_cast<float>(sharpness_) : 1.F;
    lanes.freePerMetre[k] = band.hasView() ? band.freePerMetre : 0.F;
    lanes.peak[k] = band.peak;
    lanes.reach[k] = band.reach_m;
    lanes.width[k] = band.width_m;
}

void OccupancyModel::addFree(const std::uint32_t* ids, float* squared, int n,
                             const double* x, Sums<double>& sums) const {
    bands::kernel().normalFall(squared, n);
    for (int k = 0; k < n; ++k) {
        const Joint& joint = freeJoints_[ids[k]];
        double meanW = joint.meanW_m;
        for (int d = 0; d < 3; ++d)
            meanW += double(joint.slope[d]) * (x[d] - double(joint.place.mean(d)));
        sums.passed.add(double(joint.peak) * double(squared[k]), meanW,
                        meanW * meanW + double(joint.varianceW_m2));
    }
}

}  // namespace hgmm
