#include "occupancy/occupancy_model.h"

#include <algorithm>
#include <cmath>

#include "base/dual.h"
#include "base/growth.h"
#include "hgmm/params.h"

namespace hgmm {

namespace {

constexpr double kSigmas = OccupancyModel::kSigmas;
/// Of points that rays passed and that no component answers for [1/m^3].
constexpr double kPassedDensity = 0.05;
/// Cells of coverage reach at most this far past a surface, in edges at its range: some
/// were marked from farther away.
constexpr double kSideCells = 1.5;

BoxCells::Box boxAround(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& halfExtent) {
    BoxCells::Box box;
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

/// Support times density at the mean [1/m^3], without functions of the C library, whose
/// last bits change with the processor.
float peakOf(double support, const WhitenedGaussian<3, float>& g) {
    constexpr double kInverseTwoPi32 = 0.063493635934240969;  // (2 pi)^(-3/2)
    const double density = kInverseTwoPi32 * double(g.factor(0, 0)) *
                           double(g.factor(1, 1)) * double(g.factor(2, 2));
    return static_cast<float>(std::min(support * density, 1e30));
}

}  // namespace

OccupancyModel::OccupancyModel(const OccupancyParams& params, const Surfaces& surfaces,
                               const Coverage& coverage, const Openings& openings)
    : params_(params),
      surfaces_(surfaces),
      coverage_(coverage),
      openings_(openings),
      unknownDensity_(static_cast<float>(std::exp(-0.5 * square(params.knownSigmas)))),
      sharpness_(square(params.knownSigmas / params.extentSigmas)) {
    params.validate();
}

OccupancyModel::OccupancyModel(const OccupancyModel& o, const Surfaces& surfaces,
                               const Coverage& coverage, const Openings& openings)
    : params_(o.params_),
      surfaces_(surfaces),
      coverage_(coverage),
      openings_(openings),
      unknownDensity_(o.unknownDensity_),
      sharpness_(o.sharpness_),
      freeJoints_(o.freeJoints_),
      boxes_(o.boxes_),
      bandBoxes_(o.bandBoxes_),
      freeBoxes_(o.freeBoxes_),
      bounds_(o.bounds_) {}

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
    joint.peak = peakOf(g.support, joint.place);
    return joint;
}

float OccupancyModel::sideReach_m(const OccupancyParams& params,
                                  const ViewDirection& view) {
    return static_cast<float>(kSideCells * params.coverage.edgeAt(view.range_m));
}

BoxCells::Box OccupancyModel::reachOf(const OccupancyParams& params,
                                      const Gaussian<3>& surface,
                                      const ViewDirection& view) {
    const auto reach_m = static_cast<float>(params.band.reach(view.range_m));
    const Eigen::Vector3d front = (view.known() ? reach_m : 0.F) * view.direction;
    const Eigen::Vector3d back =
        (view.known() ? -sideReach_m(params, view) : 0.F) * view.direction;
    return boxAround(surface.mean + back, surface.mean + front, ellipsoidExtent(surface));
}

BoxCells::Box OccupancyModel::reachOf(const Gaussian<4>& component) {
    const Eigen::Vector3d mean = component.mean.head<3>();
    return boxAround(mean, mean, ellipsoidExtent(component));
}

std::array<float, 3> OccupancyModel::whitenedView(std::uint32_t i) const {
    const Factor& factor = surfaces_.index.factor(i);
    const ViewDirection view = surfaces_.views[i];
    std::array<float, 3> v{};
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col <= row; ++col)
            v[row] += factor.factor(row, col) * static_cast<float>(view.direction[col]);
    return v;
}

OccupancyModel::Band OccupancyModel::bandOf(std::uint32_t i, float viewPrecision) const {
    const double range_m = surfaces_.views[i].range_m;
    Band band;
    band.peak = peakOf(surfaces_.rows.support[i], surfaces_.index.factor(i));
    band.viewPrecision = viewPrecision;
    if (band.viewPrecision > 0) band.tau_m = 1.F / std::sqrt(band.viewPrecision);
    band.width_m = static_cast<float>(params_.band.width(range_m));
    band.reach_m = static_cast<float>(params_.band.reach(range_m));
    band.freePerMetre = static_cast<float>(params_.band.freePerMetre(range_m));
    return band;
}

void OccupancyModel::updateSurface(std::uint32_t i) {
    const BoxCells::Box box = reachOf(params_, surfaces_.rows[i], surfaces_.views[i]);
    if (i == boxes_.size()) growTo(boxes_, i + std::size_t{1});
    bandBoxes_.update(i, box, boxes_.at(i).centre);
    boxes_[i] = box;
    bounds_.reset();
}

void OccupancyModel::truncateSurfaces(std::size_t n) {
    bandBoxes_.truncate(n, [this](std::uint32_t i) { return boxes_[i].centre; });
    if (boxes_.size() <= n) return;
    boxes_.resize(n);
    bounds_.reset();
}

void OccupancyModel::updateFree(std::uint32_t i, const Gaussian<4>& component) {
    if (i == freeJoints_.size()) growTo(freeJoints_, i + std::size_t{1});
    Joint& joint = freeJoints_.at(i);
    freeBoxes_.update(i, reachOf(component),
                      {joint.place.mean(0), joint.place.mean(1), joint.place.mean(2)});
    joint = jointOf(component);
}

template <typename T>
OccupancyModel::Answer<T> OccupancyModel::answer(const T* x) const {
    return answer(sums(x), openings_.at(x), coverage_.at(x));
}

template <typename T>
OccupancyModel::Answer<T> OccupancyModel::answer(const Sums<T>& s, const T& open,
                                                 const T& covered) const {
    Answer<T> answer;
    const T stands = 1.0 - open;
    const T coverage = covered * (1.0 - stands * s.sides.shadow());
    const T free = s.atHits.density + coverage * (s.passed.density + kPassedDensity);
    const T occupied = stands * s.occupied;
    const T total = occupied + free;
    if (!(valueOf(total) > 1e-300)) return answer;
    const T known = 1.0 - unknownDensity_ / (s.known + unknownDensity_) * (1.0 - coverage);
    answer.occupied = occupied / total * known;  // thesis eq. (4.15)
    answer.free = free / total * known;          // thesis eq. (4.16)

    const double c = valueOf(coverage);
    const double weight =
        valueOf(occupied) + valueOf(s.atHits.density) + c * valueOf(s.passed.density);
    if (!(weight > 1e-300)) return answer;
    answer.alongRay_m =  // thesis eq. (4.17)
        (s.atHits.distance + c * s.passed.distance) / weight;
    answer.variance_m2 =  // thesis eq. (4.18)
        std::max(0.0, (s.atHits.squaredDistance + c * s.passed.squaredDistance) / weight -
                          square(answer.alongRay_m));
    return answer;
}

Occupancy OccupancyModel::at(const Eigen::Vector3d& point) const {
    return point.allFinite() ? occupancyOf(answer(point.data())) : Occupancy{};
}

Occupancy OccupancyModel::occupancyOf(const Answer<double>& a) {
    Occupancy result;
    result.occupied = static_cast<float>(std::clamp(a.occupied, 0.0, 1.0));
    result.free =
        std::min(static_cast<float>(std::clamp(a.free, 0.0, 1.0)), 1.F - result.occupied);
    result.unknown = std::max(0.F, 1.F - result.occupied - result.free);
    result.alongRay_m = static_cast<float>(a.alongRay_m);
    result.variance_m2 = static_cast<float>(a.variance_m2);
    return result;
}

template OccupancyModel::Answer<double> OccupancyModel::answer(const Sums<double>&,
                                                               const double&,
                                                               const double&) const;

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
    return freeJoints_.capacity() * sizeof(Joint) +
           boxes_.capacity() * sizeof(BoxCells::Box) + bandBoxes_.liveBytes() +
           freeBoxes_.liveBytes();
}

}  // namespace hgmm
