// Odometry over a recording: processor time of a scan, and
// the error of the trajectory (ATE: rms distance
// after the best rigid alignment) beside a reference.
//   build/bin/bench-tracking LOG.rawlog [REFERENCE.tum]
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/recording.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/evaluation/trajectory.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/tracker.h"

namespace {

using namespace hgmm::evaluation;
using hgmm::Pose;

/// rms distance of positions, and rms angle [rad], after the best rigid alignment.
std::pair<double, double> trajectoryError(const std::vector<Pose>& found,
                                          const std::vector<Pose>& truth) {
    const auto n = static_cast<Eigen::Index>(found.size());
    Eigen::Matrix3Xd a(3, n), b(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
        a.col(i) = found[static_cast<std::size_t>(i)].t;
        b.col(i) = truth[static_cast<std::size_t>(i)].t;
    }
    const Eigen::Matrix4d T = Eigen::umeyama(a, b, false);
    double metres2 = 0.0, radians2 = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Eigen::Vector3d moved =
            T.topLeftCorner<3, 3>() * found[i].t + T.topRightCorner<3, 1>();
        metres2 += (moved - truth[i].t).squaredNorm();
        const Eigen::Matrix3d turned =
            T.topLeftCorner<3, 3>() * found[i].R * truth[i].R.transpose();
        const double angle = Eigen::AngleAxisd(turned).angle();
        radians2 += angle * angle;
    }
    return {std::sqrt(metres2 / double(n)), std::sqrt(radians2 / double(n))};
}

void run(const std::string& log, const std::string& reference) {
    RecordingOptions options;
    options.posesRequired = false;
    Recording recording(log, options);
    Trajectory truth;
    if (!reference.empty()) truth = readTrajectory(reference);

    hgmm::ScanTracker tracker;
    std::vector<Pose> found, known;
    std::vector<double> milliseconds;
    std::size_t lost = 0;
    while (const auto recorded = recording.next()) {
        const auto scan = hgmm::mrpt_bridge::observationToScan(
            *recorded->observation, std::nullopt, hgmm::mrpt_bridge::Channels::none);
        if (!scan || scan->size() == 0) continue;
        const std::clock_t begin = std::clock();
        const hgmm::TrackedPose pose = tracker.track(*scan, recorded->time_s);
        milliseconds.push_back(1e3 * double(std::clock() - begin) / CLOCKS_PER_SEC);
        if (pose.lost) ++lost;
        const Pose T_map_robot = pose.T_map_sensor * scan->T_map_sensor.inverse();
        const auto there = poseAt(truth, recorded->time_s, kMaxPoseGap_s);
        if (!there) continue;
        found.push_back(T_map_robot);
        known.push_back(*there);
    }
    std::printf(
        "scans %zu, lost %zu, median %.1f ms, mean %.1f ms, components %zu\n",
        milliseconds.size(), lost, median(milliseconds),
        [&] {
            double sum = 0;
            for (double m : milliseconds) sum += m;
            return sum / double(milliseconds.size());
        }(),
        tracker.map().mixture().size());
    if (found.size() > 2) {
        const auto [metres, radians] = trajectoryError(found, known);
        std::printf("ATE %.3f m, %.2f deg over %zu poses\n", metres, radians * 57.29578,
                    found.size());
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::fputs("usage: bench-tracking LOG.rawlog [REFERENCE.tum]\n", stderr);
        return 2;
    }
    try {
        run(argv[1], argc == 3 ? argv[2] : "");
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench-tracking: %s\n", e.what());
        return 1;
    }
}
