#include "localisation/observation_likelihood.h"

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observation/recent_observations.h"

namespace hgmm::mrpt_bridge {

namespace {

/// Indices of `count` of n points, one from each of `count` equal stretches. The place
/// within its stretch varies, because the rows of an organised scan would resonate with a
/// fixed stride.
std::vector<std::size_t> spreadIndices(std::size_t n, std::size_t count) {
    constexpr double goldenRatio = 0.6180339887498949;
    std::vector<std::size_t> indices;
    const double stretch = double(n) / double(std::min(n, count));
    for (std::size_t i = 0; i < std::min(n, count); ++i) {
        const double place = stretch > 1 ? std::fmod(double(i) * goldenRatio, 1.0) : 0.0;
        indices.push_back(
            std::min(n - 1, static_cast<std::size_t>((double(i) + place) * stretch)));
    }
    return indices;
}

/// Sum of logarithms, of which few are taken.
class LogOfProduct {
 public:
    /// @param factor in [1e-9, 1]
    void multiply(double factor) {
        product_ *= factor;
        if (product_ < 1e-280) {
            log_ += std::log(product_);
            product_ = 1;
        }
    }
    double log() const { return log_ + std::log(product_); }

 private:
    double product_ = 1, log_ = 0;
};

using Points = std::vector<Eigen::Vector3d>;  // in the robot's frame

/// How many points are compared at most.
std::size_t countOf(const mrpt::obs::CObservation& observation,
                    const LikelihoodParams& params) {
    if (params.maxPoints > 0) return static_cast<std::size_t>(params.maxPoints);
    return IS_CLASS(observation, mrpt::obs::CObservation2DRangeScan) ? 60 : 1000;
}

/// Null for observations that cannot be understood.
std::shared_ptr<const Points> pointsToCompare(const mrpt::obs::CObservation& observation,
                                              const LikelihoodParams& params) {
    params.validate();
    const auto scan = observationToScan(observation, std::nullopt, Channels::none);
    if (!scan) return nullptr;
    auto points = std::make_shared<Points>();
    std::vector<std::size_t> inRange;
    for (std::size_t i = 0; i < scan->size(); ++i) {
        const double range = std::hypot(scan->x[i], scan->y[i], scan->z[i]);
        if (range >= params.minRange_m && range <= params.maxRange_m) inRange.push_back(i);
    }
    const Pose& T_robot_sensor = scan->T_map_sensor;
    for (const std::size_t k :
         spreadIndices(inRange.size(), countOf(observation, params))) {
        const std::size_t i = inRange[k];
        points->push_back(T_robot_sensor.R *
                              Eigen::Vector3d(scan->x[i], scan->y[i], scan->z[i]) +
                          T_robot_sensor.t);
    }
    return points;
}

auto& recentPoints() {
    static RecentObservations<LikelihoodParams, Points> recent(Digested::sample);
    return recent;
}

std::uint64_t nextNumber() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

}  // namespace

ObservationLikelihood::ObservationLikelihood()
    : family_(AskedPoses::ofProcess().newFamily()), number_(nextNumber()) {}

ObservationLikelihood::ObservationLikelihood(const ObservationLikelihood& o)
    : number_(nextNumber()) {
    *this = o;
}

ObservationLikelihood& ObservationLikelihood::operator=(const ObservationLikelihood& o) {
    if (this == &o) return *this;
    const std::scoped_lock lock(mutex_, o.mutex_);
    surfaces_ = o.surfaces_;
    stale_ = o.stale_;
    ownSurfaces_ = o.ownSurfaces_ = nullptr;
    family_ = o.family_;
    return *this;
}

double ObservationLikelihood::operator()(const Map& map, const LikelihoodParams& params,
                                         const mrpt::obs::CObservation& observation,
                                         const mrpt::poses::CPose3D& T_map_robot) const {
    const std::uint64_t digest = digestOf(observation, Digested::sample);
    const auto points = recentPoints().get(
        observation, digest, params, [&] { return pointsToCompare(observation, params); });
    if (!points || points->empty()) return 0;

    const Pose T = toPose(T_map_robot);
    const Eigen::Vector3d t_local = T.t - map.origin();
    auto kernel = fixedKernel(params);
    if (!kernel)
        kernel = AskedPoses::ofProcess().kernelAt(family_, number_, observation, digest,
                                                  t_local, T.R);
    if (map.empty()) return 0;
    const auto surfaces = surfacesOf(map, *kernel);
    const auto compared =
        static_cast<std::size_t>(std::ceil(double(points->size()) * kernel->shareOfPoints));
    LogOfProduct product;
    for (std::size_t i = 0; i < compared; ++i) {
        const Eigen::Vector3d& p = (*points)[i * points->size() / compared];
        const Eigen::Vector3f local = (T.R * p + t_local).cast<float>();
        product.multiply(surfaces->likelihood.probability(local.x(), local.y(), local.z()));
    }
    return product.log() * std::min(1.0, kernel->independentPoints / double(compared));
}

void ObservationLikelihood::invalidate() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stale_ = true;
}

void ObservationLikelihood::forgetPoses() {
    family_ = AskedPoses::ofProcess().newFamily();
}

ObservationLikelihood::Heritage ObservationLikelihood::heritage() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    ownSurfaces_ = nullptr;
    return {family_, surfaces_};
}

void ObservationLikelihood::inherit(const Heritage& heritage) {
    const std::lock_guard<std::mutex> lock(mutex_);
    family_ = heritage.family;
    surfaces_ = heritage.surfaces.lock();
    ownSurfaces_ = nullptr;
    // The original may have changed since it brought them up to date.
    stale_ = true;
}

void ObservationLikelihood::forgetObservations() {
    recentPoints().forget();
}

std::shared_ptr<const ObservationLikelihood::Surfaces> ObservationLikelihood::surfacesOf(
    const Map& map, const LikelihoodKernel& kernel) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!surfaces_ || surfaces_->kernelWidth_m != kernel.kernelWidth_m ||
        surfaces_->outlierRatio != kernel.outlierRatio) {
        ownSurfaces_ = std::make_shared<Surfaces>(Surfaces{
            SurfaceLikelihood(map.mixture(), kernel.kernelWidth_m, kernel.outlierRatio),
            kernel.kernelWidth_m, kernel.outlierRatio});
        surfaces_ = ownSurfaces_;
    } else if (stale_ && !surfaces_->likelihood.isOf(map.mixture())) {
        if (!ownSurfaces_) ownSurfaces_ = std::make_shared<Surfaces>(*surfaces_);
        surfaces_ = ownSurfaces_;
        ownSurfaces_->likelihood.update(map.mixture());
    }
    stale_ = false;
    return surfaces_;
}

}  // namespace hgmm::mrpt_bridge
