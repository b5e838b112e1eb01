#include "hgmm/tracker.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/require_rigid.h"
#include "tracking/motion.h"
#include "tracking/scan_alignment.h"
#include "tracking/tracker_impl.h"

namespace hgmm {

namespace {

/// Alignment begins with no wider kernel [m], [rad]: surfaces that are farther are others.
constexpr SearchRadius kNearest{1.5, 0.5};
/// With less of a scan found, or less than this share of what was found of the last one,
/// mixtures are registered, in case the sensor is elsewhere [1].
constexpr double kLittle = 0.45, kFallen = 0.75;
/// A sensor is not where the map calls so many times as much of a scan free as it explains
/// [1].
constexpr double kContradicted = 0.7;
/// So many times as much is doubtful [1].
constexpr double kDoubtful = 0.2;
/// So is a pose that is so many deviations from the prior.
constexpr double kSurprising = 2.0;
/// Another pose is taken if it explains so much more of the scan [1].
constexpr double kBetterBy = 0.05;
/// A doubtful pose is believed if it explains so much of the scan [1].
constexpr double kConvincing = 0.2;
/// A scan that suddenly contradicts the map so much more than the last one that was not
/// lost, in free space and behind surfaces, is seen from elsewhere, whatever else fits [1].
/// Half as much does for the next ones, and after a gap.
constexpr double kAbrupt = 0.2;
/// After a gap in which the sensor may have come farther than this, one of several places
/// that fit alike is not taken for being near [m].
constexpr double kVague_m = 0.5;
/// A motion is not guessed to go on for longer than this [s].
constexpr double kLongestGuess_s = 1.0;
/// Odometry that recognises no scan so often in a row goes on from the prior in a new map
/// [scans]: the sensor is where the old one does not reach.
constexpr int kAnewAfter = 5;

/// Standard deviations of position and rotation, of all axes together.
SearchRadius deviationOf(const Matrix6d& covariance) {
    return {std::sqrt(covariance.bottomRightCorner<3, 3>().trace()),
            std::sqrt(covariance.topLeftCorner<3, 3>().trace())};
}

SearchRadius narrower(const SearchRadius& a, const SearchRadius& b) {
    return {std::min(a.width_m, b.width_m), std::min(a.angle_rad, b.angle_rad)};
}

void requireCovariance(const Registration::Covariance& covariance, const char* what) {
    if (!covariance.allFinite() ||
        Eigen::LLT<Matrix6d>(Matrix6d(covariance)).info() != Eigen::Success)
        throw std::invalid_argument(std::string(what) +
                                    ": the covariance is not positive definite");
}

SearchRadius wider(const SearchRadius& a, const SearchRadius& b) {
    return {std::max(a.width_m, b.width_m), std::max(a.angle_rad, b.angle_rad)};
}

const TrackerParams& checked(const TrackerParams& params) {
    params.validate();
    return params;
}

}  // namespace

ScanTracker::Impl::Impl(const MapParams& mapParams, const TrackerParams& trackerParams,
                        const PoseEstimate& start)
    : params(checked(trackerParams)),
      pose(start),
      deviation({params.firstDeviation_m, params.firstDeviation_rad}),
      local(mapParams, params) {
    requireRigid(start.T_map_sensor, "tracker: the start");
    requireCovariance(start.covariance, "tracker: the start");
}

void ScanTracker::Impl::require(const Scan& scan, double time,
                                const std::optional<MotionIncrement>& odometry,
                                const std::vector<float>& pointTimes_s) const {
    scan.validate();
    if (!std::isfinite(time))
        throw std::invalid_argument("tracker: the time is not finite");
    if (time_s && time < *time_s)
        throw std::invalid_argument("tracker: a scan is earlier than the last");
    if (odometry) {
        requireRigid(odometry->T_last_now, "tracker: odometry");
        requireCovariance(odometry->covariance, "tracker: odometry");
    }
    if (!pointTimes_s.empty() && pointTimes_s.size() != scan.size())
        throw std::invalid_argument("tracker: another number of times than of points");
}

double ScanTracker::Impl::sinceLast(double time) const {
    return time_s ? time - *time_s : 0.0;
}

PoseEstimate ScanTracker::Impl::predict(
    double time, const std::optional<MotionIncrement>& odometry) const {
    if (!time_s) return pose;
    MotionIncrement motion;
    if (odometry) {
        motion = *odometry;
    } else {
        if (velocity)
            motion.T_last_now = velocity->after(std::min(sinceLast(time), kLongestGuess_s));
        motion.covariance = covarianceOf(wider(deviation.now(), unknownSince(time)));
    }
    motion.covariance = inPlaneOfRays(motion.covariance, samples.normalOfRays_sensor);
    return compose(pose, motion);
}

SearchRadius ScanTracker::Impl::unknownSince(double time) const {
    if (!velocity) return {params.firstDeviation_m, params.firstDeviation_rad};
    const double notGuessed_s = std::max(0.0, sinceLast(time) - kLongestGuess_s);
    return {notGuessed_s * fastest.width_m, notGuessed_s * fastest.angle_rad};
}

bool ScanTracker::Impl::isBelieved(const PoseHypothesis& found,
                                   const PoseEstimate& prior) const {
    // Odometry has nothing to set it right later.
    const bool doubtful = !given && isDoubtful(found, prior);
    return found.overlap >= std::max(params.minOverlap, doubtful ? kConvincing : 0.0) &&
           found.contradicted <= kContradicted * found.overlap;
}

bool ScanTracker::Impl::isDoubtful(const PoseHypothesis& found,
                                   const PoseEstimate& prior) const {
    const SearchRadius off = searchRadius(prior);
    return found.overlap < std::max(kLittle, kFallen * overlap) ||
           found.contradicted > kDoubtful * found.overlap ||
           isFarFrom(prior.T_map_sensor, found.T_map_sensor,
                     {kSurprising * off.width_m, kSurprising * off.angle_rad});
}

SearchRadius ScanTracker::Impl::searchRadius(const PoseEstimate& prior) const {
    return wider(deviation.now(), deviationOf(prior.covariance));
}

FoundPose ScanTracker::Impl::find(const PoseEstimate& prior, bool vague) const {
    const ScanAlignment alignment(map(), *target, samples,
                                  static_cast<std::size_t>(params.maxSamples));
    const SearchRadius off = searchRadius(prior);
    const double abrupt = vague || lostInARow > 0 ? 0.5 * kAbrupt : kAbrupt;
    const auto judged = [&](const PoseHypothesis& at) {
        const double share =
            given ? 0.0 : at.contradicted + alignment.shareBehindSurfaces(at.T_map_sensor);
        return FoundPose{at, isBelieved(at, prior) && !isAbrupt(share, abrupt), share};
    };
    const auto isClear = [&](const FoundPose& found) {
        return !vague && !isAbrupt(found.conflict, abrupt) &&
               !isDoubtful(found.best, prior);
    };
    FoundPose found = judged(alignment.near(prior, narrower(off, kNearest)));
    if (isClear(found)) return found;
    std::vector<PoseHypothesis> all{found.best};
    if (const auto farther = alignment.farther(prior)) {
        all.push_back(*farther);
        if (farther->score() > found.best.score() + kBetterBy) found = judged(*farther);
    }
    if (given || isClear(found)) return found;
    const std::size_t precise = all.size();
    for (const PoseHypothesis& rough : alignment.farAround(prior)) all.push_back(rough);
    const auto chosen = clearlyBest(all, prior.T_map_sensor, off, vague);
    if (!chosen) {
        found.isBelieved = false;
        return found;
    }
    return judged(*chosen < precise ? all[*chosen]
                                    : alignment.refined(all[*chosen], prior));
}

void ScanTracker::Impl::renewTarget() {
    target = std::make_unique<PatchTree<3>>(map().mixture());
}

bool ScanTracker::Impl::beginAnew() {
    lostInARow = 0;
    overlap = 0.0;
    conflict.reset();
    // Odometry may not have noticed that the sensor was carried away.
    const SearchRadius unknown{2.0 * params.firstDeviation_m,
                               2.0 * params.firstDeviation_rad};
    pose.covariance += inPlaneOfRays(covarianceOf(unknown), samples.normalOfRays_sensor);
    local.clear();
    const bool isIn = local.insert(samples, pose.T_map_sensor, scans);
    renewTarget();
    return isIn;
}

ScanTracker::ScanTracker(const MapParams& mapParams, const TrackerParams& params,
                         const PoseEstimate& start)
    : impl_(std::make_unique<Impl>(mapParams, params, start)) {}

ScanTracker::ScanTracker(std::shared_ptr<const Map> map, const PoseEstimate& start,
                         const TrackerParams& params) {
    if (!map || map->empty()) throw std::invalid_argument("tracker: the map is empty");
    impl_ = std::make_unique<Impl>(map->params(), params, start);
    impl_->given = std::move(map);
    impl_->renewTarget();
}

ScanTracker::ScanTracker(ScanTracker&&) noexcept = default;
ScanTracker& ScanTracker::operator=(ScanTracker&&) noexcept = default;
ScanTracker::~ScanTracker() = default;

TrackedPose ScanTracker::track(const Scan& scan, double time_s,
                               const std::optional<MotionIncrement>& odometry,
                               const std::vector<float>& pointTimes_s) {
    Impl& t = *impl_;
    t.require(scan, time_s, odometry, pointTimes_s);
    const double duration_s = t.sinceLast(time_s);
    Velocity velocity = t.velocity.value_or(Velocity());
    if (odometry && duration_s > 0.0)
        velocity = Velocity::of(odometry->T_last_now, duration_s);
    t.samples = samplesOf(
        pointTimes_s.empty() ? scan : motionTakenOut(scan, pointTimes_s, velocity),
        t.map().params());
    const PoseEstimate prior = t.predict(time_s, odometry);

    TrackedPose now;
    static_cast<PoseEstimate&>(now) = prior;
    if (!t.map().empty()) {
        const bool vague = !odometry && t.unknownSince(time_s).width_m > kVague_m;
        const auto [found, isBelieved, conflict] = t.find(prior, vague);
        now.overlap = found.overlap;
        now.contradicted = found.contradicted;
        now.observable = found.observable;
        now.lost = !isBelieved;
        if (!now.lost) {
            static_cast<PoseEstimate&>(now) = found;
            t.conflict = conflict;
            t.deviation.learn(prior.T_map_sensor, now.T_map_sensor);
        }
    }
    if (now.lost)
        t.velocity.reset();
    else if (t.time_s && duration_s > 0.0) {
        t.velocity =
            Velocity::of(t.pose.T_map_sensor.inverse() * now.T_map_sensor, duration_s);
        t.fastest =
            wider(t.fastest, {t.velocity->linear.norm(), t.velocity->angular.norm()});
    }
    t.pose = now;
    t.time_s = time_s;
    t.overlap = now.overlap;
    if (!t.given && !now.lost && t.local.insert(t.samples, now.T_map_sensor, t.scans)) {
        now.inserted = true;
        t.renewTarget();
    }
    t.lostInARow = now.lost && !t.samples.samples_sensor.empty() ? t.lostInARow + 1 : 0;
    if (!t.given && t.lostInARow >= kAnewAfter) {
        now.inserted = t.beginAnew();
        now.covariance = t.pose.covariance;
    }
    ++t.scans;
    return now;
}

const Map& ScanTracker::map() const {
    return impl_->map();
}

const ScanSamples& ScanTracker::lastSamples() const {
    return impl_->samples;
}

}  // namespace hgmm
