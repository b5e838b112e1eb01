// What hgmm-slam makes of simulated recordings whose truth is known. Prints a row of a
// table for each kind of run.
//   bench-slam-studies pairs|rooms|loops|corridor|disturbed|tunnel planar|rings [RUNS]
// `pairs` verifies closures between rooms that look alike; the others drive a robot through
// a place. The exit code says nothing of the figures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "runs.h"
#include "worlds.h"

namespace {

using namespace hgmm;
using namespace hgmm::slam_studies;

constexpr double kStep_m = 0.15;
constexpr double kWrong_m = 0.5;  ///< a pose that is farther off is wrong

std::vector<Pose> throughTheRoom(double y, double yaw_rad) {
    std::vector<Pose> poses;
    const double ahead = std::cos(yaw_rad) > 0 ? 1.0 : -1.0;
    for (int k = 0; k < 6; ++k)
        poses.push_back({slam::rotationOf({0, 0, yaw_rad}), {ahead * (0.8 * k - 2), y, 0}});
    return poses;
}

/// A pose that drift has put off by as much as its covariance says.
slam::UncertainPose guessAbout(const Pose& truth, std::mt19937_64& random) {
    constexpr double kOff_m = 0.5, kOff_rad = 0.15;
    std::normal_distribution<double> normal;
    slam::Vector6d error = slam::Vector6d::Zero();
    error[2] = kOff_rad * normal(random);
    error[3] = kOff_m * normal(random);
    error[4] = kOff_m * normal(random);
    slam::UncertainPose guess{slam::displacedBy(truth, error), slam::Matrix6d::Zero()};
    guess.covariance.diagonal() << 1e-6, 1e-6, kOff_rad * kOff_rad, kOff_m * kOff_m,
        kOff_m * kOff_m, 1e-6;
    return guess;
}

void pairs(const SimulatedSensor& sensor, int count) {
    std::puts("| rooms | pairs | taken for the same place | of these, off by > .1 m |");
    std::puts("| --- | --- | --- | --- |");
    for (const auto& [how, name] : {std::pair{Furniture::same, "the same, seen again"},
                                    {Furniture::rearranged, "all furniture elsewhere"},
                                    {Furniture::halfMoved, "half of it elsewhere"},
                                    {Furniture::halfMissing, "half of it missing"}}) {
        std::mt19937_64 random(1);
        int taken = 0, wrong = 0;
        for (int k = 0; k < count; ++k) {
            const FurnishedRoom room = FurnishedRoom::random(random);
            const FurnishedRoom other = room.changed(how, random);
            const auto there = throughTheRoom(0.3, 0.0);
            const auto back = throughTheRoom(-0.2, k % 2 == 0 ? 0.0 : M_PI);
            const Pose truth = there[0].inverse() * back[0];
            const auto found = slam::verifiedPose(
                submapAlong(room.scene(), sensor, there, k),
                submapAlong(other.scene(), sensor, back, k), guessAbout(truth, random), {});
            taken += found ? 1 : 0;
            wrong += found && (found->T_a_b.t - truth.t).norm() > 0.1 ? 1 : 0;
        }
        std::printf("| %s | %d | %d | %d |\n", name, count, taken, wrong);
        std::fflush(stdout);
    }
}

/// Figures of runs of one kind: worst ones, and how many went wrong.
class Row {
 public:
    explicit Row(std::string name) : name_(std::move(name)) {}

    static void head() {
        std::puts(
            "| run | runs | wrong and silent | say so | scans lost | closures | false "
            "| end off by, median | worst | of the way | worst within a part |");
        std::puts("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    }
    void add(const Run& run) {
        ++runs_;
        silent_ += run.worstInPart_m > kWrong_m && run.parts == 1 ? 1 : 0;
        saySo_ += run.parts > 1 ? 1 : 0;
        lost_ += run.lostScans;
        closures_ += run.closures;
        false_ += run.falseClosures;
        endErrors_m_.push_back(run.endError_m);
        worstShare_ = std::max(worstShare_, run.endError_m / run.way_m);
        worstInPart_m_ = std::max(worstInPart_m_, run.worstInPart_m);
        std::fprintf(
            stderr,
            "%s: end %.3f m, in part %.3f m, parts %zu, lost %zu, loops %zu, false %zu\n",
            name_.c_str(), run.endError_m, run.worstInPart_m, run.parts, run.lostScans,
            run.closures, run.falseClosures);
    }
    void print() {
        std::sort(endErrors_m_.begin(), endErrors_m_.end());
        std::printf(
            "| %s | %d | %d | %d | %zu | %zu | %zu | %.3f m | %.3f m | %.3f %% | %.3f m "
            "|\n",
            name_.c_str(), runs_, silent_, saySo_, lost_, closures_, false_,
            endErrors_m_[endErrors_m_.size() / 2], endErrors_m_.back(), 100 * worstShare_,
            worstInPart_m_);
        std::fflush(stdout);
    }

 private:
    std::string name_;
    int runs_ = 0, silent_ = 0, saySo_ = 0;
    std::size_t lost_ = 0, closures_ = 0, false_ = 0;
    std::vector<double> endErrors_m_;
    double worstShare_ = 0.0, worstInPart_m_ = 0.0;
};

using PlaceOf = std::function<Place(std::mt19937_64&)>;
using Disturb = std::function<void(Drive&, std::mt19937_64&)>;

void runs(const std::string& name, const SimulatedSensor& sensor, int count,
          const PlaceOf& placeOf, const Disturb& disturb) {
    Row row(name);
    for (int seed = 1; seed <= count; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const Place place = placeOf(random);
        Drive drive = driveAlong(place.way, kStep_m);
        disturb(drive, random);
        row.add(run(place.scene, sensor, drive, static_cast<std::uint64_t>(seed)));
    }
    row.print();
}

/// Odometry that is wrong by a share, either way.
OdometryError wrongBy(double share, std::mt19937_64& random) {
    const auto sign = [&] { return random() % 2 == 0 ? 1.0 : -1.0; };
    const double shift = sign() * share, turn = sign() * share;
    return {shift, turn};
}

void nothing(Drive&, std::mt19937_64&) {}
void wrongOdometry(Drive& drive, std::mt19937_64& random) {
    giveOdometry(drive, wrongBy(0.1, random), random);
}
std::size_t someScan(const Drive& drive, double from, double to, std::mt19937_64& random) {
    const double share = std::uniform_real_distribution<double>(from, to)(random);
    return static_cast<std::size_t>(share * static_cast<double>(drive.truth.size()));
}
void gap(Drive& drive, std::mt19937_64& random) {
    leaveOut(drive, someScan(drive, 0.1, 0.8, random), 5.0);
}
void missing(Drive& drive, std::mt19937_64& random) {
    leaveOut(drive, 0.2, random);
}
void carried(Drive& drive, std::mt19937_64& random) {
    const std::size_t at = someScan(drive, 0.15, 0.3, random);
    carryAway(drive, at, someScan(drive, 0.4, 0.7, random));
}

void disturbed(const SimulatedSensor& sensor, int count) {
    Row::head();
    const std::vector<std::pair<std::string, Disturb>> kinds = {
        {"carried away", carried}, {"gap of 5 s", gap}, {"20 % of scans missing", missing}};
    for (const auto& [name, disturb] : kinds) {
        runs(name, sensor, count, twoLoops, disturb);
        runs(name + ", odometry 10 % off", sensor, count, twoLoops,
             [d = disturb](Drive& drive, std::mt19937_64& random) {
                 wrongOdometry(drive, random);
                 d(drive, random);
             });
    }
    runs("odometry 10 % off", sensor, count, twoLoops, wrongOdometry);
}

void rooms(const SimulatedSensor& sensor, int count) {
    Row::head();
    const auto place = [](std::mt19937_64& random) { return lookAlikeRooms(4, random); };
    runs("rooms that look alike", sensor, count, place, nothing);
    runs("the same, odometry 10 % off", sensor, count, place, wrongOdometry);
}

void loops(const SimulatedSensor& sensor, int count) {
    Row::head();
    runs("two loops", sensor, count, twoLoops, nothing);
    runs("two loops, odometry 10 % off", sensor, count, twoLoops, wrongOdometry);
}

void corridor(const SimulatedSensor& sensor, int count) {
    std::puts(
        "| odometry off by | found: off by, along | one sigma, along | across | heading |");
    std::puts("| --- | --- | --- | --- | --- |");
    for (int seed = 1; seed <= count; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const Place place = smoothCorridor(30.0);
        Drive drive = driveAlong(place.way, kStep_m);
        giveOdometry(drive, wrongBy(0.05, random), random);
        const Run r = run(place.scene, sensor, drive, static_cast<std::uint64_t>(seed));
        const Pose truth = drive.truth.front().inverse() * drive.truth.back();
        const Pose found = r.found.front().inverse() * r.found.back();
        const auto end = slam::poseOfAll(r.graph, 0).back();
        std::printf("| %.2f m | %.2f m | %.2f m | %.3f m | %.2f deg |\n",
                    drive.odometry.back().t.x() - truth.t.x(), found.t.x() - truth.t.x(),
                    std::sqrt(end.covariance(3, 3)), found.t.y() - truth.t.y(),
                    slam::rotationVectorOf(found.R).z() * 180 / M_PI);
        std::fflush(stdout);
    }
}

void tunnels(const SimulatedSensor& sensor, int count) {
    Row::head();
    const double length_m = 100.0 * count;
    Row row("tunnel of " + std::to_string(100 * count) + " m");
    std::mt19937_64 random(1);
    const Place place = tunnel(length_m, random);
    const Drive drive = driveAlong(place.way, 0.1);
    row.add(run(place.scene, sensor, drive, 1));
    row.print();
}

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, std::pair<void (*)(const SimulatedSensor&, int), int>>
        studies = {{"pairs", {pairs, 1000}},       {"rooms", {rooms, 20}},
                   {"loops", {loops, 5}},          {"corridor", {corridor, 5}},
                   {"disturbed", {disturbed, 20}}, {"tunnel", {tunnels, 20}}};
    const auto study = argc >= 3 ? studies.find(argv[1]) : studies.end();
    const std::string sensor = argc >= 3 ? argv[2] : "";
    const int count = argc > 3                 ? std::atoi(argv[3])
                      : study != studies.end() ? study->second.second
                                               : 0;
    if (study == studies.end() || count < 1 || argc > 4 ||
        (sensor != "planar" && sensor != "rings")) {
        std::fputs(
            "usage: bench-slam-studies pairs|rooms|loops|corridor|disturbed|tunnel "
            "planar|rings [RUNS]\n",
            stderr);
        return 2;
    }
    try {
        study->second.first(sensorOf(sensor == "planar"), count);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench-slam-studies: %s\n", e.what());
        return 1;
    }
}
