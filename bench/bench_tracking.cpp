// Odometry over a recording, or localisation in a map of it: processor time of a scan, and
// the error beside a reference (ATE: rms distance after the best rigid alignment).
//   build/bin/bench-tracking LOG.rawlog [REFERENCE.tum [N | OUT.tum]]
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/pose_landscape.h"
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

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

/// Processor time of all threads.
template <class Work>
double millisecondsOf(const Work& work) {
    const std::clock_t begin = std::clock();
    work();
    return 1e3 * double(std::clock() - begin) / CLOCKS_PER_SEC;
}

std::optional<hgmm::Scan> scanOf(const RecordedScan& recorded) {
    auto scan = hgmm::mrpt_bridge::observationToScan(
        *recorded.observation, recorded.T_map_robot, hgmm::mrpt_bridge::Channels::none);
    if (scan && scan->size() == 0) scan.reset();
    return scan;
}

RecordingOptions optionsFor(const std::string& reference) {
    RecordingOptions options;
    if (reference.empty())
        options.posesRequired = false;
    else
        options.posesFile = reference;
    return options;
}

void odometry(const std::string& log, const std::string& reference,
              const std::string& output) {
    Recording recording(log, optionsFor(reference));
    hgmm::ScanTracker tracker;
    std::vector<Pose> found, known;
    Trajectory trajectory;
    std::vector<double> milliseconds;
    std::size_t lost = 0;
    while (const auto recorded = recording.next()) {
        const auto scan = scanOf(*recorded);
        if (!scan) continue;
        hgmm::TrackedPose pose;
        milliseconds.push_back(
            millisecondsOf([&] { pose = tracker.track(*scan, recorded->time_s); }));
        if (pose.lost) ++lost;
        const Pose T_map_robot = hgmm::mrpt_bridge::toPose(recorded->T_map_robot);
        found.push_back(pose.T_map_sensor * (scan->T_map_sensor.inverse() * T_map_robot));
        known.push_back(T_map_robot);
        trajectory.push_back({recorded->time_s, found.back()});
    }
    std::printf("odometry: scans %zu, lost %zu, median %.1f ms, mean %.1f ms\n",
                milliseconds.size(), lost, median(milliseconds), mean(milliseconds));
    if (!reference.empty()) {
        const auto [metres, radians] = trajectoryError(found, known);
        std::printf("ATE %.3f m, %.2f deg\n", metres, radians * 180.0 / M_PI);
    }
    if (!output.empty()) writeTumTrajectory(output, trajectory);
}

/// A map of all but every n-th scan; these are localised in it, each from the one before.
void localisation(const std::string& log, const std::string& reference, std::size_t n) {
    auto map = std::make_shared<hgmm::Map>();
    std::vector<std::pair<double, hgmm::Scan>> heldOut;
    Recording recording(log, optionsFor(reference));
    while (const auto recorded = recording.next()) {
        const auto scan = scanOf(*recorded);
        if (!scan) continue;
        if (recorded->index % n == 0)
            heldOut.emplace_back(recorded->time_s, *scan);
        else
            map->insert(*scan);
    }
    hgmm::PoseEstimate start;
    start.T_map_sensor = heldOut.front().second.T_map_sensor;
    hgmm::ScanTracker tracker(map, start);
    std::vector<double> metres, degrees, milliseconds;
    std::size_t lost = 0, wrong = 0;
    for (const auto& [time_s, scan] : heldOut) {
        hgmm::TrackedPose pose;
        milliseconds.push_back(
            millisecondsOf([&, t = time_s, &s = scan] { pose = tracker.track(s, t); }));
        const PoseError error = errorOf(pose.T_map_sensor, scan.T_map_sensor);
        metres.push_back(error.position_m);
        degrees.push_back(error.rotation_deg);
        if (pose.lost) ++lost;
        if (!pose.lost && error.position_m > 0.5) ++wrong;
    }
    std::printf(
        "localisation: scans %zu, lost %zu, wrong %zu, median %.3f m, %.2f deg, %.1f ms, "
        "mean %.1f ms\n",
        heldOut.size(), lost, wrong, median(metres), median(degrees), median(milliseconds),
        mean(milliseconds));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 4) {
        std::fputs(
            "usage: bench-tracking LOG.rawlog [REFERENCE.tum [N | OUT.tum]]\n"
            "odometry, its poses into OUT; with N, localisation of every N-th scan in a "
            "map of the others\n",
            stderr);
        return 2;
    }
    try {
        const std::string reference = argc > 2 ? argv[2] : "",
                          third = argc > 3 ? argv[3] : "";
        const int n = std::atoi(third.c_str());
        if (n >= 2)
            localisation(argv[1], reference, static_cast<std::size_t>(n));
        else
            odometry(argv[1], reference, third);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench-tracking: %s\n", e.what());
        return 1;
    }
}
