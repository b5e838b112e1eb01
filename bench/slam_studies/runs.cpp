#include "runs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "hgmm/slam/odometry.h"

namespace hgmm::slam_studies {
namespace {

using slam::Vector6d;

constexpr double kNoise_m = 0.01;
/// A closure that is farther off is false, unless its covariance says so.
constexpr double kFalse_m = 0.3, kFalse_rad = 0.1;

Scan scanAt(const Scene& scene, const SimulatedSensor& sensor, const Pose& truth,
            std::uint64_t seed, std::size_t index) {
    return evaluation::scanOf(evaluation::simulateReturns(
                                  scene, sensor, truth, {kNoise_m, 0.0, 0.3}, seed, index),
                              sensor, Pose{}, evaluation::WithoutReturn::leftOut);
}

Pose poseAt(const Eigen::Vector2d& place, double yaw_rad) {
    return {slam::rotationOf({0, 0, yaw_rad}), {place.x(), place.y(), 0}};
}

/// Groups of submaps that are held together by what is no guess.
std::vector<std::size_t> partOf(const slam::PoseGraph& graph) {
    std::vector<std::size_t> part(graph.T_world_node.size());
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (const slam::PoseEdge& edge : graph.edges) {
        if (slam::isGuess(edge.T_from_to)) continue;
        const std::size_t kept = part[edge.from], joined = part[edge.to];
        std::replace(part.begin(), part.end(), joined, kept);
    }
    return part;
}

void judge(const Drive& drive, Run& run) {
    const std::vector<std::size_t> part = partOf(run.graph);
    std::vector<Pose> T_truth_node(run.graph.T_world_node.size());
    std::map<std::size_t, std::size_t> firstOfPart;
    std::vector<bool> isKnown(T_truth_node.size(), false);
    for (std::size_t i = 0; i < drive.truth.size(); ++i) {
        if (i > 0) run.way_m += (drive.truth[i].t - drive.truth[i - 1].t).norm();
        if (run.lost[i]) continue;
        const std::size_t k = run.submap[i];
        if (!isKnown[k])
            T_truth_node[k] =
                drive.truth[i] * run.found[i].inverse() * run.graph.T_world_node[k];
        isKnown[k] = true;
        const std::size_t first = firstOfPart.emplace(part[k], i).first->second;
        const Pose truth = drive.truth[first].inverse() * drive.truth[i];
        const Pose found = run.found[first].inverse() * run.found[i];
        run.worstInPart_m = std::max(run.worstInPart_m, (truth.t - found.t).norm());
    }
    for (const slam::PoseEdge& edge : run.graph.edges) {
        if (edge.kind != slam::PoseEdge::Kind::closure) continue;
        const Vector6d error =
            slam::errorOf(edge.T_from_to.T_a_b,
                          T_truth_node[edge.from].inverse() * T_truth_node[edge.to]);
        if (error.tail<3>().norm() < kFalse_m && error.head<3>().norm() < kFalse_rad)
            continue;
        if (slam::squaredMahalanobis(error, edge.T_from_to.covariance) <
            slam::kChiSquareOfSix)
            continue;
        ++run.falseClosures;
        std::fprintf(stderr, "false closure %zu - %zu: off by %.2f m, %.2f rad\n",
                     edge.from, edge.to, error.tail<3>().norm(), error.head<3>().norm());
    }
    run.endError_m = ((drive.truth.front().inverse() * drive.truth.back()).t -
                      (run.found.front().inverse() * run.found.back()).t)
                         .norm();
}

template <class Element>
void keep(std::vector<Element>& all, const std::vector<bool>& kept) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (kept[i]) all[next++] = all[i];
    all.resize(next);
}

void keepOf(Drive& drive, const std::vector<bool>& kept) {
    keep(drive.truth, kept);
    keep(drive.time_s, kept);
    if (!drive.odometry.empty()) keep(drive.odometry, kept);
}

}  // namespace

Drive driveAlong(const Waypoints& way, double step_m) {
    constexpr double kTurn_rad = 0.1, kRadPerSecond = 0.8;
    Drive drive;
    double yaw_rad = 0.0, time_s = 0.0;
    const auto add = [&](const Eigen::Vector2d& place, double after_s) {
        time_s += after_s;
        drive.truth.push_back(poseAt(place, yaw_rad));
        drive.time_s.push_back(time_s);
    };
    const Eigen::Vector2d begin = way[1] - way[0];
    yaw_rad = std::atan2(begin.y(), begin.x());
    add(way[0], 0.0);
    for (std::size_t k = 1; k < way.size(); ++k) {
        const Eigen::Vector2d leg = way[k] - way[k - 1];
        const double turn =
            std::remainder(std::atan2(leg.y(), leg.x()) - yaw_rad, 2 * M_PI);
        const int turns = static_cast<int>(std::ceil(std::abs(turn) / kTurn_rad - 1e-9));
        for (int j = 0; j < turns; ++j) {
            yaw_rad += turn / turns;
            add(way[k - 1], std::abs(turn) / turns / kRadPerSecond);
        }
        const int steps = static_cast<int>(std::ceil(leg.norm() / step_m - 1e-9));
        for (int j = 1; j <= steps; ++j)
            add(way[k - 1] + leg * j / steps, leg.norm() / steps);
    }
    return drive;
}

void giveOdometry(Drive& drive, const OdometryError& error, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    drive.odometry = {Pose{}};
    for (std::size_t i = 1; i < drive.truth.size(); ++i) {
        Pose motion = drive.truth[i - 1].inverse() * drive.truth[i];
        motion.t *= 1.0 + error.shiftShare;
        motion.t += 0.003 * Eigen::Vector3d(normal(random), normal(random), 0);
        const double turn_rad =
            slam::rotationVectorOf(motion.R).z() * (1.0 + error.turnShare) +
            0.002 * normal(random);
        motion.R = slam::rotationOf({0, 0, turn_rad});
        drive.odometry.push_back(drive.odometry.back() * motion);
    }
}

void leaveOut(Drive& drive, std::size_t from, double seconds) {
    std::vector<bool> kept(drive.truth.size(), true);
    for (std::size_t i = from; i < kept.size(); ++i)
        kept[i] = drive.time_s[i] > drive.time_s[from] + seconds;
    keepOf(drive, kept);
}

void leaveOut(Drive& drive, double share, std::mt19937_64& random) {
    std::bernoulli_distribution isMissing(share);
    std::vector<bool> kept(drive.truth.size(), true);
    for (std::size_t i = 1; i < kept.size(); ++i) kept[i] = !isMissing(random);
    keepOf(drive, kept);
}

void carryAway(Drive& drive, std::size_t at, std::size_t to) {
    const auto move = [&](auto& all) { all.erase(all.begin() + at, all.begin() + to); };
    constexpr double kCarried_s = 2.0;
    const double earlier_s = drive.time_s[to] - drive.time_s[at] - kCarried_s;
    for (std::size_t i = to; i < drive.time_s.size(); ++i) drive.time_s[i] -= earlier_s;
    if (!drive.odometry.empty()) {
        const Pose back = drive.odometry[at] * drive.odometry[to].inverse();
        for (std::size_t i = to; i < drive.odometry.size(); ++i)
            drive.odometry[i] = back * drive.odometry[i];
        move(drive.odometry);
    }
    move(drive.truth);
    move(drive.time_s);
}

Run run(const Scene& scene, const SimulatedSensor& sensor, const Drive& drive,
        std::uint64_t seed) {
    slam::SubmapSlam map;
    slam::Odometry odometry({}, Pose{});
    Run result;
    for (std::size_t i = 0; i < drive.truth.size(); ++i) {
        std::optional<slam::UncertainPose> given;
        if (!drive.odometry.empty() && i > 0)
            given = slam::givenMotion(drive.odometry[i - 1].inverse() * drive.odometry[i]);
        const slam::UncertainPose step = odometry.step(
            scanAt(scene, sensor, drive.truth[i], seed, i), drive.time_s[i], given);
        if (odometry.held())
            map.add(odometry.lastSamples(), Pose{}, step);
        else
            map.addLost(step);
        result.lost.push_back(odometry.lost());
        result.submap.push_back(map.submaps() - 1);
    }
    map.finish();
    result.found = map.trajectory();
    result.graph = map.graph();
    result.closures = map.closures();
    result.parts = map.parts();
    result.lostScans =
        static_cast<std::size_t>(std::count(result.lost.begin(), result.lost.end(), true));
    judge(drive, result);
    return result;
}

slam::FinishedSubmap submapAlong(const Scene& scene, const SimulatedSensor& sensor,
                                 const std::vector<Pose>& truth, std::uint64_t seed) {
    slam::Submap submap{MapParams{}};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        submap.T_submap_robot.push_back(truth[0].inverse() * truth[i]);
        submap.map.insert(
            samplesOf(scanAt(scene, sensor, truth[i], seed, i), submap.map.params()),
            submap.T_submap_robot.back());
    }
    return slam::FinishedSubmap(std::move(submap));
}

}  // namespace hgmm::slam_studies
