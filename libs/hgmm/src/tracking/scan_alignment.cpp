#include "tracking/scan_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hgmm/registration.h"
#include "tracking/motion.h"
#include "tracking/place_candidates.h"

namespace hgmm {

namespace {

/// Registration looks so far about the prior [m], [rad].
constexpr double kSearch_m = 0.7, kSearch_rad = 0.4;
/// What it finds may be off by this much [m], [rad].
constexpr SearchRadius kFound{0.1, 0.02};
/// Samples that are asked whether they lie in space that is known to be free.
constexpr std::size_t kAskedSamples = 200;
/// P(free) of such space.
constexpr float kSurelyFree = 0.8F;
/// P(unknown) of what may lie behind a surface.
constexpr float kUnknown = 0.5F;
/// A surface lies before a point if it is nearer than this share of its range, less this
/// [m].
constexpr double kBeforePoint = 0.9, kBeforePoint_m = 0.2;

/// Places are looked at as far as this share of the samples' distance from the sensor, and
/// no nearer and no farther than this [m].
constexpr double kFarPerRange = 0.5, kLeastFar_m = 1.0, kMostFar_m = 10.0;
/// So many places on each side of the prior.
constexpr int kPlacesEachWay = 6;
/// The likeliest are aligned, with so many samples.
constexpr std::size_t kAlignedPlaces = 16, kFarSamples = 500;
/// Samples that rate a place.
constexpr std::size_t kRatingSamples = 150;
/// A pose far from the prior must explain so much more than one at the prior, and one at
/// kFarSquared squared deviations half of it: the tail of the prior is heavy [1].
constexpr double kFarPoses = 0.1, kFarSquared = 4.0;
/// Of poses that explain as much, give or take this [1], the nearest to the prior is taken,
constexpr double kLead = 0.05;
/// unless another place is hardly farther: by less than this, squared.
constexpr double kRivalSquared = 4.0;

/// A disc about the origin, at even steps.
std::vector<Eigen::Vector3d> placesAbout(const Eigen::Vector3d& centre, double far_m) {
    std::vector<Eigen::Vector3d> places;
    for (int x = -kPlacesEachWay; x <= kPlacesEachWay; ++x)
        for (int y = -kPlacesEachWay; y <= kPlacesEachWay; ++y)
            if (x * x + y * y <= kPlacesEachWay * kPlacesEachWay)
                places.push_back(centre +
                                 far_m / kPlacesEachWay * Eigen::Vector3d(x, y, 0.0));
    return places;
}

}  // namespace

ScanAlignment::ScanAlignment(const Map& map, const PatchTree<3>& surfaces,
                             const ScanSamples& scan, std::size_t most)
    : map_(map),
      surfaces_(surfaces),
      scan_(scan),
      samples_(scan.samples_sensor, scan.normalOfRays_sensor, most),
      asked_(scan.samples_sensor, scan.normalOfRays_sensor, kAskedSamples) {}

Registration::Covariance ScanAlignment::widened(const Registration::Covariance& covariance,
                                                const SearchRadius& by) const {
    return covariance + inPlaneOfRays(covarianceOf(by), scan_.normalOfRays_sensor);
}

PoseHypothesis ScanAlignment::near(const PoseEstimate& prior,
                                   const SearchRadius& off) const {
    return aligned(prior, off, samples_);
}

PoseHypothesis ScanAlignment::aligned(const PoseEstimate& prior, const SearchRadius& off,
                                      const AlignmentSamples& samples) const {
    AlignmentPrior about;
    about.T_target_sensor = {prior.T_map_sensor.R, prior.T_map_sensor.t - map_.origin()};
    about.covariance = prior.covariance;
    about.deviation = off;
    const SurfaceAlignment found = alignToSurfaces(surfaces_, samples, about);
    PoseHypothesis hypothesis;
    hypothesis.T_map_sensor = {orthonormal(found.T_target_sensor.R),
                               found.T_target_sensor.t + map_.origin()};
    hypothesis.covariance = found.covariance;
    hypothesis.overlap = found.overlap;
    hypothesis.observable = found.observable;
    hypothesis.contradicted = shareInFreeSpace(hypothesis.T_map_sensor);
    return hypothesis;
}

std::vector<Eigen::Vector3d> ScanAlignment::askedPoints(const Pose& T_map_sensor) const {
    std::vector<Eigen::Vector3d> points_map;
    for (const Eigen::Vector3d& m : asked_.mean)
        points_map.push_back(T_map_sensor.R * m + T_map_sensor.t);
    return points_map;
}

double ScanAlignment::shareInFreeSpace(const Pose& T_map_sensor) const {
    if (asked_.size() == 0) return 0.0;
    const std::vector<Eigen::Vector3d> points_map = askedPoints(T_map_sensor);
    std::vector<Occupancy> answers(points_map.size());
    map_.occupancy(points_map.data(), points_map.size(), answers.data());
    const auto inFree = std::count_if(answers.begin(), answers.end(),
                                      [](const auto& a) { return a.free > kSurelyFree; });
    return double(inFree) / double(asked_.size());
}

double ScanAlignment::shareBehindSurfaces(const Pose& T_map_sensor) const {
    if (asked_.size() == 0) return 0.0;
    const std::vector<Eigen::Vector3d> points_map = askedPoints(T_map_sensor);
    int behind = 0;
#pragma omp parallel for schedule(dynamic, 16) reduction(+ : behind)
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(points_map.size()); ++k) {
        const Eigen::Vector3d& point_map = points_map[static_cast<std::size_t>(k)];
        if (map_.occupancy(point_map).unknown < kUnknown) continue;
        const Eigen::Vector3d ray = point_map - T_map_sensor.t;
        RayCastParams upToPoint;
        upToPoint.maxRange_m = kBeforePoint * ray.norm() - kBeforePoint_m;
        if (upToPoint.maxRange_m > 0.0 && map_.castRay(T_map_sensor.t, ray, upToPoint))
            ++behind;
    }
    return double(behind) / double(asked_.size());
}

std::optional<PoseHypothesis> ScanAlignment::farther(const PoseEstimate& prior) const {
    RegistrationParams search;
    search.coarseWidth_m = kSearch_m;
    search.coarseAngle_rad = kSearch_rad;
    std::vector<const Mixture<3>*> levels;
    for (std::size_t level = map_.levelCount(); level > 0; --level)
        levels.push_back(&map_.mixture(level - 1));
    const Registration coarse = registerMixtures(
        levels, scan_.samples_sensor,
        {prior.T_map_sensor.R, prior.T_map_sensor.t - map_.origin()}, search);
    if (!coarse.converged) return {};
    const Pose T_map_sensor{orthonormal(coarse.T_target_source.R),
                            coarse.T_target_source.t + map_.origin()};
    return near({T_map_sensor, widened(prior.covariance, {kSearch_m, kSearch_rad})},
                kFound);
}

std::vector<PoseHypothesis> ScanAlignment::farAround(const PoseEstimate& prior) const {
    const double far_m =
        std::clamp(kFarPerRange * samples_.gyrationRadius_m, kLeastFar_m, kMostFar_m);
    const double apart_m = far_m / kPlacesEachWay;
    PlaceSearch search;
    search.kernelWidth_m = 0.7 * apart_m;
    search.mostKept = kAlignedPlaces;
    search.samples = kRatingSamples;
    search.R_local = prior.T_map_sensor.R;
    const std::vector<PlaceCandidate> places = likeliestPlaces(
        map_, scan_, placesAbout(prior.T_map_sensor.t - map_.origin(), far_m), search);
    const SearchRadius off{apart_m, 2.0 * M_PI / search.headings};
    const AlignmentSamples few(scan_.samples_sensor, scan_.normalOfRays_sensor,
                               kFarSamples);
    std::vector<PoseHypothesis> found(places.size());
#pragma omp parallel for schedule(dynamic)
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(places.size()); ++k) {
        const auto i = static_cast<std::size_t>(k);
        const Pose T_map_sensor{places[i].T_local_sensor.R,
                                places[i].T_local_sensor.t + map_.origin()};
        found[i] = aligned({T_map_sensor, covarianceOf(off)}, off, few);
    }
    return found;
}

PoseHypothesis ScanAlignment::refined(const PoseHypothesis& hypothesis,
                                      const PoseEstimate& prior) const {
    const double far_m = (hypothesis.T_map_sensor.t - prior.T_map_sensor.t).norm();
    return near({hypothesis.T_map_sensor, widened(prior.covariance, {far_m, M_PI})},
                kFound);
}

std::optional<std::size_t> clearlyBest(const std::vector<PoseHypothesis>& hypotheses,
                                       const Pose& prior, const SearchRadius& off,
                                       bool priorIsVague) {
    std::vector<double> squared, rated;  // deviations from the prior; scores
    for (const PoseHypothesis& h : hypotheses) {
        const double shift = (h.T_map_sensor.t - prior.t).norm() / off.width_m;
        const double turn =
            rotationVector(h.T_map_sensor.R * prior.R.transpose()).norm() / off.angle_rad;
        squared.push_back(shift * shift + turn * turn);
        rated.push_back(h.score() -
                        kFarPoses * squared.back() / (squared.back() + kFarSquared));
    }
    const double enough = *std::max_element(rated.begin(), rated.end()) - kLead;
    std::size_t best = hypotheses.size();
    for (std::size_t k = 0; k < hypotheses.size(); ++k)
        if (rated[k] >= enough && (best == hypotheses.size() || squared[k] < squared[best]))
            best = k;
    if (squared[best] < 1.0 && !priorIsVague) return best;
    const double rivals = kRivalSquared * std::max(squared[best], 1.0);
    for (std::size_t k = 0; k < hypotheses.size(); ++k)
        if (rated[k] >= enough && squared[k] < rivals &&
            !areOnePlace(hypotheses[k].T_map_sensor, hypotheses[best].T_map_sensor))
            return {};
    return best;
}

}  // namespace hgmm
