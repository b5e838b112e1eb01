#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <thread>
#include <vector>

#include "copy_through_archive.h"
#include "observations.h"

using archives::copyThroughArchive;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::poses::CPose3D;

namespace {

CHGMMOccupancyMap askableMap() {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::laser(), CPose3D(0, 0, 0.2, 0, 0, 0));
    map.insertObservation(*observations::laser(), CPose3D(0, 0, 0.2, M_PI, 0, 0));
    return map;
}

CObservation2DRangeScan::Ptr scanAt(double seconds, const std::string& sensor = "front") {
    auto scan = observations::laser();
    scan->timestamp = mrpt::Clock::fromDouble(1.7e9 + seconds);
    scan->sensorLabel = sensor;
    return scan;
}

const CPose3D kProbe(0.06, 0.03, 0.2, 0.02, 0, 0);

/// Poses around kProbe, spread by so much.
std::vector<CPose3D> posesAround(double metres, double radians = 0.0) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal;
    std::vector<CPose3D> poses = {kProbe};
    for (int i = 0; i < 200; ++i)
        poses.emplace_back(kProbe.x() + metres * normal(engine),
                           kProbe.y() + metres * normal(engine), 0.2,
                           kProbe.yaw() + radians * normal(engine), 0, 0);
    return poses;
}

std::vector<double> ask(const CHGMMOccupancyMap& map,
                        const mrpt::obs::CObservation& observation,
                        const std::vector<CPose3D>& poses) {
    std::vector<double> values;
    for (const CPose3D& pose : poses)
        values.push_back(map.computeObservationLikelihood(observation, pose));
    return values;
}

/// The likelihood with the kernel for poses of unknown spread.
double wideValue(const CHGMMOccupancyMap& map, const CPose3D& pose = kProbe) {
    CHGMMOccupancyMap fresh;
    fresh.model() = map.model();
    return fresh.computeObservationLikelihood(*scanAt(0), pose);
}
double narrowValue(const CHGMMOccupancyMap& map) {
    CHGMMOccupancyMap fixed = map;
    fixed.likelihoodOptions.independentPoints = 60;
    return fixed.computeObservationLikelihood(*scanAt(0), kProbe);
}

bool isWide(const CHGMMOccupancyMap& map, const mrpt::obs::CObservation& scan) {
    return map.computeObservationLikelihood(scan, kProbe) == wideValue(map);
}
bool isNarrow(const CHGMMOccupancyMap& map, const mrpt::obs::CObservation& scan) {
    return std::abs(map.computeObservationLikelihood(scan, kProbe) - narrowValue(map)) <
           1e-9;
}

TEST(AskedPoses, WideAtTheStartNarrowOnceTheyAgree) {
    const CHGMMOccupancyMap map = askableMap();
    EXPECT_TRUE(isWide(map, *scanAt(1)));
    ask(map, *scanAt(1), posesAround(2, 2));
    EXPECT_TRUE(isWide(map, *scanAt(2)));
    ask(map, *scanAt(2), posesAround(0.05, 0.03));
    EXPECT_LT(narrowValue(map), wideValue(map) - 1) << "the probe tells them apart";
    EXPECT_TRUE(isNarrow(map, *scanAt(3)));
    // Headings count as positions do, and the next observation follows at once.
    ask(map, *scanAt(3), posesAround(0.05, 0.5));
    EXPECT_TRUE(isWide(map, *scanAt(4)));
    // Between, it is neither.
    ask(map, *scanAt(4), posesAround(0.25, 0.03));
    EXPECT_FALSE(isWide(map, *scanAt(5)));
    EXPECT_FALSE(isNarrow(map, *scanAt(5)));
}

// Where no point is near a surface, all that counts is the outlier ratio.
TEST(AskedPoses, OutliersOfTheWideKernelCountAsFifteen) {
    const CHGMMOccupancyMap map = askableMap();
    EXPECT_NEAR(wideValue(map, CPose3D(1e3, 0, 0, 0, 0, 0)), 15 * std::log(0.3), 1e-9);
}

TEST(AskedPoses, NothingIsKnownAfterClearingLoadingAndForgetting) {
    const auto converged = [](const CHGMMOccupancyMap& map) {
        ask(map, *scanAt(1), posesAround(0.05));
        return isNarrow(map, *scanAt(2));
    };
    CHGMMOccupancyMap map = askableMap();
    EXPECT_TRUE(converged(map));
    const CHGMMOccupancyMap another = askableMap();
    EXPECT_TRUE(isWide(another, *scanAt(3)));
    map.forgetPoses();
    EXPECT_TRUE(isWide(map, *scanAt(2))) << "also of an observation that it knew";

    EXPECT_TRUE(converged(another));
    map = askableMap();
    EXPECT_TRUE(converged(map));
    map.clear();
    map.model() = another.model();
    EXPECT_TRUE(isWide(map, *scanAt(3)));

    const std::string file = (std::filesystem::temp_directory_path() /
                              ("asked_poses_" + std::to_string(::getpid()) + ".hgmm"))
                                 .string();
    another.saveToFile(file);
    CHGMMOccupancyMap loaded = askableMap();
    EXPECT_TRUE(converged(loaded));
    loaded.loadFromFile(file);
    EXPECT_TRUE(isWide(loaded, *scanAt(3)));
    std::filesystem::remove(file);
}

TEST(AskedPoses, KernelIsOneForAllPosesInAnyOrderAndThread) {
    const auto before = posesAround(0.25, 0.1), poses = posesAround(1);
    const CHGMMOccupancyMap map = askableMap();
    ask(map, *scanAt(1), before);
    const auto expected = ask(map, *scanAt(2), poses);

    auto backwards = before;
    std::reverse(backwards.begin(), backwards.end());
    const CHGMMOccupancyMap other = askableMap();
    ask(other, *scanAt(1), backwards);
    std::vector<CPose3D> reversed(poses.rbegin(), poses.rend());
    auto values = ask(other, *scanAt(2), reversed);
    std::reverse(values.begin(), values.end());
    EXPECT_EQ(values, expected);

    const CHGMMOccupancyMap shared = askableMap();
    const auto askInTwoThreads = [&](double seconds, const std::vector<CPose3D>& all) {
        const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
        const std::vector<CPose3D> first(all.begin(), middle), second(middle, all.end());
        std::vector<double> a, b;
        std::thread one([&] { a = ask(shared, *scanAt(seconds), first); });
        std::thread two([&] { b = ask(shared, *scanAt(seconds), second); });
        one.join();
        two.join();
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    askInTwoThreads(1, before);
    EXPECT_EQ(askInTwoThreads(2, poses), expected);
}

TEST(AskedPoses, CopiesOfAMapKnowWhatItKnows) {
    const CHGMMOccupancyMap map = askableMap();
    ask(map, *scanAt(1), posesAround(0.05));
    const CHGMMOccupancyMap copy = map;
    const auto archived = copyThroughArchive(map);
    EXPECT_TRUE(isNarrow(copy, *scanAt(2)));
    EXPECT_TRUE(isNarrow(*archived, *scanAt(2)));
    // And one knows of the others.
    ask(*archived, *scanAt(2), posesAround(2));
    EXPECT_TRUE(isWide(map, *scanAt(3)));
    // A map that is equal, and was not copied, is another.
    CHGMMOccupancyMap equal;
    equal.model() = map.model();
    EXPECT_TRUE(isWide(equal, *scanAt(2)));
    EXPECT_TRUE(isWide(*copyThroughArchive(equal), *scanAt(2)));
}

// Each particle of a mapping filter has a map of its own, whose frame has drifted.
TEST(AskedPoses, SpreadIsThatWithinTheMapsOfParticles) {
    const CHGMMOccupancyMap first = askableMap();
    std::vector<CHGMMOccupancyMap::Ptr> particles;
    for (int k = 0; k < 5; ++k) particles.push_back(copyThroughArchive(first));
    const auto drifted = [](std::vector<CPose3D> poses, int k) {
        for (CPose3D& pose : poses) pose = CPose3D(10.0 * k, 0, 0, 0.5 * k, 0, 0) + pose;
        return poses;
    };
    for (int k = 0; k < 5; ++k)
        ask(*particles[k], *scanAt(1), drifted(posesAround(0.05), k));
    for (const auto& particle : particles) EXPECT_TRUE(isNarrow(*particle, *scanAt(2)));
    for (int k = 0; k < 5; ++k) ask(*particles[k], *scanAt(2), drifted(posesAround(1), k));
    for (const auto& particle : particles) EXPECT_TRUE(isWide(*particle, *scanAt(3)));
}

// Particles that are drawn once a step lie as far apart as its noise.
TEST(AskedPoses, ParticlesThatDoNotSearchHaveAWideKernelOfAllPoints) {
    const CHGMMOccupancyMap first = askableMap();
    std::vector<CHGMMOccupancyMap::Ptr> particles;
    for (int k = 0; k < 5; ++k) particles.push_back(copyThroughArchive(first));
    for (const auto& particle : particles) ask(*particle, *scanAt(1), {kProbe});
    // Asking again about the same pose, or about none, is no search.
    ask(*particles[3], *scanAt(1), {kProbe, kProbe});
    ask(*particles[4], *scanAt(1), {CPose3D(std::nan(""), 0, 0, 0, 0, 0)});
    CHGMMOccupancyMap fixed = first;
    fixed.likelihoodOptions.kernelWidth_m = 0.2;
    const double expected = fixed.computeObservationLikelihood(*scanAt(0), kProbe);
    for (const auto& particle : particles)
        EXPECT_NEAR(particle->computeObservationLikelihood(*scanAt(2), kProbe), expected,
                    1e-9);
    // One that searches tells of its spread, and for all of them.
    ask(*particles[0], *scanAt(2), posesAround(0.05));
    for (const auto& particle : particles) EXPECT_TRUE(isNarrow(*particle, *scanAt(3)));
    // One map that is asked about one pose is no filter.
    const CHGMMOccupancyMap alone = askableMap();
    ask(alone, *scanAt(1), {kProbe});
    EXPECT_TRUE(isNarrow(alone, *scanAt(2)));
}

// Maps that were made before any was asked may be one filter's particles, also while they
// are empty.
TEST(AskedPoses, MapsMadeTogetherAreOneFilters) {
    CHGMMOccupancyMap a, b;
    ask(a, *scanAt(1), posesAround(0.05));
    ask(b, *scanAt(1), posesAround(0.05));
    b.insertObservation(*observations::laser(), CPose3D(0, 0, 0.2, 0, 0, 0));
    a.model() = b.model();
    EXPECT_TRUE(isNarrow(a, *scanAt(2)));
    ask(a, *scanAt(2), posesAround(3));
    EXPECT_TRUE(isWide(b, *scanAt(3)));
}

// Every particle may be asked about all sensors in turn: after one pose, little is known.
TEST(AskedPoses, SensorsAskedInTurnHaveKernelsOfTheirOwn) {
    const CHGMMOccupancyMap map = askableMap();
    const auto askInTurn = [&](double seconds, const std::vector<CPose3D>& poses) {
        const auto front = scanAt(seconds), back = scanAt(seconds + 0.001, "back"),
                   sameTime = scanAt(seconds, "front");
        sameTime->setSensorPose(CPose3D(-0.1, 0, 0, 0, 0, 0));

        for (const CPose3D& pose : poses) {
            map.computeObservationLikelihood(*front, pose);
            map.computeObservationLikelihood(*back, pose);
            map.computeObservationLikelihood(*sameTime, pose);
        }
        return isWide(map, *front) && isWide(map, *back);
    };
    EXPECT_TRUE(askInTurn(1, posesAround(2)));
    EXPECT_TRUE(askInTurn(2, posesAround(0.05)));
    EXPECT_FALSE(askInTurn(3, posesAround(0.05)));
    EXPECT_TRUE(isNarrow(map, *scanAt(3)));
    EXPECT_TRUE(isNarrow(map, *scanAt(3.001, "back")));
}

TEST(AskedPoses, LogThatStartsAnewIsWideAgain) {
    const CHGMMOccupancyMap map = askableMap();
    for (int k = 10; k < 60; ++k) ask(map, *scanAt(k), posesAround(0.05));
    EXPECT_TRUE(isNarrow(map, *scanAt(60)));
    EXPECT_TRUE(isWide(map, *scanAt(5)));
}

TEST(AskedPoses, OrderOfAskingCountsWhereThereAreNoTimeStamps) {
    const CHGMMOccupancyMap map = askableMap();
    const auto unstamped = [](float range) {
        auto scan = observations::laser();
        scan->timestamp = INVALID_TIMESTAMP;
        scan->sensorLabel = "front";
        scan->setScanRange(0, range);
        return scan;
    };
    ask(map, *unstamped(1.F), posesAround(0.05));
    ask(map, *unstamped(2.F), posesAround(2));
    ask(map, *unstamped(3.F), posesAround(0.05));
    const double wide = map.computeObservationLikelihood(*unstamped(3.F), kProbe);
    EXPECT_LT(map.computeObservationLikelihood(*unstamped(4.F), kProbe), wide - 1);
}

// What says nothing of a pose does not count, and a kernel that is set asks for no spread.
TEST(AskedPoses, OnlyComparedObservationsCount) {
    CHGMMOccupancyMap map = askableMap();
    mrpt::obs::CObservationOdometry odometry;
    odometry.timestamp = scanAt(1)->timestamp;
    odometry.sensorLabel = "front";
    ask(map, odometry, posesAround(0.05));
    CObservation2DRangeScan empty;
    empty.timestamp = scanAt(1)->timestamp;
    empty.sensorLabel = "front";
    ask(map, empty, posesAround(0.05));
    map.likelihoodOptions.kernelWidth_m = 0.3;
    ask(map, *scanAt(2), posesAround(0.05));
    map.likelihoodOptions.kernelWidth_m = 0;
    EXPECT_TRUE(isWide(map, *scanAt(3)));
}

}  // namespace
