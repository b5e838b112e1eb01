#include <gtest/gtest.h>
#include <omp.h>

#include <optional>

#include "hgmm/slam/odometry.h"
#include "hgmm/slam/submap_slam.h"
#include "walk.h"

namespace hgmm::slam {
namespace {

using namespace testing;

bool areSame(const std::vector<Pose>& a, const std::vector<Pose>& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i)
        same = a[i].R == b[i].R && a[i].t == b[i].t;
    return same;
}

std::vector<Scan> laserScansAlong(const std::vector<Pose>& way) {
    const Scene scene = ringCorridor();
    std::vector<Scan> scans;
    for (std::size_t i = 0; i < way.size(); ++i)
        scans.push_back(evaluation::scanOf(
            evaluation::simulateReturns(scene, laser(), way[i], {0.01, 0.0, 0.3}, 3, i),
            laser(), Pose{}, evaluation::WithoutReturn::leftOut));
    return scans;
}

/// Saves both parts and lets others, which know nothing else, go on from there.
void replaceByCopies(std::optional<Odometry>& odometry, std::unique_ptr<SubmapSlam>& slam,
                     const std::vector<Scan>& scans) {
    std::size_t next = 0;
    odometry = Odometry::load(odometry->save(), [&](std::size_t scan) {
        EXPECT_GE(scan, next) << "in rising order";
        next = scan + 1;
        return samplesOf(scans[scan], MapParams{});
    });
    auto copy = std::make_unique<SubmapSlam>();
    copy->load(slam->save(), [&](std::size_t k) { return slam->saveSubmap(k); });
    EXPECT_EQ(copy->finishedSubmaps(), slam->finishedSubmaps());
    slam = std::move(copy);
}

/// @param every the process ends, and another goes on, after so many scans
std::unique_ptr<SubmapSlam> followed(const std::vector<Scan>& scans, std::size_t every) {
    std::optional<Odometry> odometry(std::in_place, MapParams{}, Pose{});
    auto slam = std::make_unique<SubmapSlam>();
    for (std::size_t i = 0; i < scans.size(); ++i) {
        if (i % every == every - 1) replaceByCopies(odometry, slam, scans);
        const UncertainPose step = odometry->step(scans[i], 0.1 * double(i), std::nullopt);
        if (odometry->held())
            slam->add(odometry->lastSamples(), {}, step);
        else
            slam->addLost(step);
    }
    slam->finish();
    return slam;
}

TEST(Resume, GoesOnBitForBitWhereverItStopped) {
    const std::vector<Scan> scans = laserScansAlong(walkAround(0.5, 1.1));
    const auto whole = followed(scans, scans.size() + 1);
    EXPECT_GE(whole->closures(), 1U);
    EXPECT_GE(whole->submaps(), 5U);
    const Map map = whole->fusedMap();
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const auto parts = followed(scans, 16);
    omp_set_num_threads(threads);
    EXPECT_TRUE(areSame(parts->trajectory(), whole->trajectory()));
    EXPECT_TRUE(areSame(parts->graph().T_world_node, whole->graph().T_world_node));
    EXPECT_EQ(parts->closures(), whole->closures());
    EXPECT_EQ(g2oText(parts->graph()), g2oText(whole->graph()));
    EXPECT_TRUE(parts->fusedMap() == map);
}

TEST(Resume, RefusesWhatIsNoState) {
    const std::vector<Pose> truth = walkAround(0.25, 0.2);
    SubmapSlam slam;
    for (std::size_t i = 0; i < truth.size(); ++i)
        slam.add(samplesAt(ringCorridor(), truth[i], i), {},
                 {i > 0 ? truth[i - 1].inverse() * truth[i] : Pose{}, Matrix6d::Zero()});
    const auto submapOf = [&](std::size_t k) { return slam.saveSubmap(k); };
    const std::vector<std::uint8_t> state = slam.save();
    SubmapSlam other;
    EXPECT_THROW(other.load({}, submapOf), FormatError);
    for (const std::size_t at : {std::size_t{0}, std::size_t{5}, state.size() / 2}) {
        std::vector<std::uint8_t> damaged = state;
        damaged[at] ^= 1U;
        EXPECT_THROW(other.load(damaged, submapOf), FormatError) << at;
    }
    EXPECT_THROW(other.load({state.begin(), state.end() - 1}, submapOf), FormatError);
    EXPECT_THROW(other.load(state, [&](std::size_t) { return state; }), FormatError);
    EXPECT_EQ(other.submaps(), 0U);
    other.load(state, submapOf);
    EXPECT_TRUE(areSame(other.trajectory(), slam.trajectory()));
    slam.finish();
    EXPECT_THROW(slam.save(), std::logic_error);
    EXPECT_THROW(slam.saveSubmap(slam.submaps()), std::out_of_range);
    EXPECT_THROW(Odometry::load(state, {}), FormatError);
    const ScanTracker inGivenMap(std::make_shared<const Map>(slam.fusedMap()), {});
    EXPECT_THROW(inGivenMap.save(), std::logic_error);
}

}  // namespace
}  // namespace hgmm::slam
