#include <stdexcept>
#include <string>

#include "io/state_archive.h"
#include "tracking/tracker_impl.h"

namespace hgmm {

namespace {

constexpr StateKind kTrackerState{{'H', 'G', 'M', 'T'}, 1, "saved tracker"};

template <typename Archive>
void archiveParams(Archive& a, TrackerParams& p) {
    a(p.firstDeviation_m, p.firstDeviation_rad, p.maxSamples, p.minOverlap, p.insertEvery_m,
      p.insertEvery_rad, p.mapRadius_m);
}

}  // namespace

template <typename Archive>
void ScanTracker::Impl::archive(Archive& a) {
    a(scans, pose.T_map_sensor, pose.covariance, fastest.width_m, fastest.angle_rad,
      overlap, lostInARow);
    a.optional(time_s, [&](double& time) { a(time); });
    a.optional(velocity, [&](Velocity& v) { a(v.angular, v.linear); });
    a.optional(conflict, [&](double& share) { a(share); });
    deviation.archive(a);
    local.archive(a);
}

std::vector<std::uint8_t> ScanTracker::save() const {
    if (impl_->given) throw std::logic_error("tracker: only odometry can be saved");
    StateWriter out(kTrackerState);
    archiveParams(out, impl_->params);
    impl_->archive(out);
    return std::move(out).finish();
}

ScanTracker ScanTracker::load(
    const std::uint8_t* data, std::size_t size,
    const std::function<ScanSamples(std::size_t scan)>& samplesOfScan) {
    ScanTracker tracker;
    try {
        StateReader in(data, size, kTrackerState);
        TrackerParams params;
        archiveParams(in, params);
        tracker = ScanTracker({}, params);
        tracker.impl_->archive(in);
    } catch (const std::logic_error& e) {  // ends too early, or params out of range
        throw FormatError(std::string(kTrackerState.name) + ": " + e.what());
    }
    Impl& t = *tracker.impl_;
    std::size_t known = 0;  // scans up to the one whose samples are at hand
    const auto bring = [&](std::size_t scan) -> const ScanSamples& {
        t.samples = samplesOfScan(scan);
        known = scan + 1;
        return t.samples;
    };
    t.local.bringSamples(bring);
    if (known < t.scans) bring(t.scans - 1);
    if (!t.map().empty()) t.renewTarget();
    return tracker;
}

}  // namespace hgmm
