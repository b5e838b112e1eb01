#include "fusion/carving.h"

#include <gtest/gtest.h>

#include "hgmm/params.h"
#include "index/coarse_grid.h"
#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::normal;
using test::uniform;

const Eigen::Vector3d kOrigin(1.5, -0.5, 1.0);

void add(Mixture<3>& samples, const Eigen::Vector3d& p) {
    Gaussian<3> s;
    s.support = 1;
    s.mean = p;
    s.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    samples.pushBack(s);
}

Eigen::Vector3d randomDirection(std::mt19937_64& engine) {
    return Eigen::Vector3d(normal(engine), normal(engine), normal(engine)).normalized();
}

TEST(RayImage, GivesTheNearestMeasurementAround) {
    std::mt19937_64 engine(1);
    Mixture<3> samples;
    for (int i = 0; i < 3000; ++i)
        add(samples, kOrigin + uniform(engine, 0.5, 30) * randomDirection(engine));
    const RayImage image(samples, kOrigin);
    constexpr double bin = 2.6 * M_PI / 180;  // at the centre of a face
    int empty = 0, seen = 0;
    for (int q = 0; q < 3000; ++q) {
        const Eigen::Vector3d u = randomDirection(engine);
        const double range = image.nearestRange(u);
        double nearest = 1e9, nearestAround = 1e9, closest = 1e9;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Eigen::Vector3d ray = samples[i].mean - kOrigin;
            const double angle = std::acos(std::min(1.0, u.dot(ray.normalized())));
            closest = std::min(closest, angle);
            if (angle < 0.2 * bin) nearest = std::min(nearest, ray.norm());
            if (angle < 3 * bin) nearestAround = std::min(nearestAround, ray.norm());
        }
        if (range == 0) {
            ++empty;
        } else {
            ++seen;
            EXPECT_GE(range, nearestAround - 1e-4);
            EXPECT_LE(range, nearest + 1e9 * (closest > 0.2 * bin) + 1e-4);
        }
        if (closest > 2 * bin) {
            EXPECT_EQ(range, 0);
        }
    }
    EXPECT_GT(empty, 100);
    EXPECT_GT(seen, 100);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d ray = samples[i].mean - kOrigin;
        EXPECT_GT(image.nearestRange(ray), 0);
        EXPECT_LE(image.nearestRange(ray), ray.norm() + 1e-4);
    }
}

/// A dense scan of the plane x = `distance` from kOrigin.
RayImage wallAt(double distance) {
    Mixture<3> samples;
    for (double a = -1.2; a <= 1.2; a += 0.015)
        for (double b = -1.2; b <= 1.2; b += 0.015)
            add(samples, kOrigin + distance * Eigen::Vector3d(1, a, b));
    return {samples, kOrigin};
}

Gaussian<3> plate(const Eigen::Vector3d& mean, const Eigen::Vector3d& sigma) {
    Gaussian<3> g;
    g.support = 10;
    g.mean = mean;
    g.covariance = sigma.cwiseAbs2().asDiagonal();
    return g;
}

bool seenFrom(const Gaussian<3>& component, const RayImage& image) {
    return isSeenThrough(component, image, Eigen::Vector3d::Zero());
}

TEST(SeenThrough, WhatStandsBeforeAWallButNotTheWallNorWhatIsBehind) {
    const RayImage image = wallAt(8);
    const Eigen::Vector3d sigma(0.01, 0.15, 0.15);
    const auto seen = [&](double x) {
        return seenFrom(plate(kOrigin + Eigen::Vector3d(x, 0.7, 0.2), sigma), image);
    };
    EXPECT_TRUE(seen(3));
    EXPECT_TRUE(seen(7));
    EXPECT_FALSE(seen(8));
    EXPECT_FALSE(seen(7.98));  // within three standard deviations
    EXPECT_FALSE(seen(8.5));
    EXPECT_FALSE(seen(12));
    EXPECT_FALSE(seen(-3));  // nothing was measured there
}

TEST(SeenThrough, NotThroughNoiseThatIsAsWideAsTheStep) {
    const RayImage image = wallAt(8);
    const auto seen = [&](double noise) {
        return seenFrom(plate(kOrigin + Eigen::Vector3d(7.5, 0, 0), {noise, 0.1, 0.1}),
                        image);
    };
    EXPECT_TRUE(seen(0.05));
    EXPECT_FALSE(seen(0.25));
}

/// A dense scan of the floor, 1 m below the sensor.
Mixture<3> floorEnds() {
    Mixture<3> floor;
    for (double x = 0.3; x < 20; x += 0.02 * (1 + x))
        for (double y = -3; y < 3; y += 0.03)
            add(floor, {kOrigin.x() + x, kOrigin.y() + y, 0});
    return floor;
}

TEST(SeenThrough, NotTheFloorAtGrazingAngles) {
    const Mixture<3> floor = floorEnds();
    const RayImage image(floor, kOrigin);
    for (double x = 0.5; x < 18; x += 0.25)
        EXPECT_FALSE(seenFrom(
            plate({kOrigin.x() + x, kOrigin.y(), 0}, {0.1 * (1 + x / 5), 0.1, 0.01}),
            image))
            << x;
    // A post on it is.
    EXPECT_TRUE(
        seenFrom(plate({kOrigin.x() + 4, kOrigin.y(), 0.4}, {0.02, 0.02, 0.1}), image));
}

TEST(SeenThrough, WhatStoodOnTheFloorAlthoughRaysBelowItEndBeforeIt) {
    const Mixture<3> floor = floorEnds();
    const RayImage image(floor, kOrigin);
    const auto foot = [](double height_m, const Eigen::Vector3d& sigma) {
        return plate({kOrigin.x() + 3, kOrigin.y(), height_m}, sigma);
    };
    EXPECT_TRUE(seenFrom(foot(0.12, {0.02, 0.06, 0.04}), image));
    EXPECT_FALSE(seenFrom(foot(0.01, {0.02, 0.06, 0.04}), image));  // the floor itself
    // The way through sheets is told in cells.
    EXPECT_FALSE(seenFrom(foot(0.12, {0.005, 0.06, 0.04}), image));
    // Of its rays some end in it.
    Mixture<3> half = floor;
    for (double y = -0.1; y < 0; y += 0.03)
        for (double z = 0.05; z < 0.25; z += 0.02)
            add(half, {kOrigin.x() + 3, kOrigin.y() + y, z});
    EXPECT_FALSE(seenFrom(foot(0.12, {0.02, 0.06, 0.04}), RayImage(half, kOrigin)));
}

TEST(SeenThrough, NotASheetThatOtherRaysHit) {
    // A wall x = 4 with a doorway, |y| < hole, seen by all rays through its component.
    const auto wallWith = [&](double hole) {
        Mixture<3> samples;
        for (double a = -0.6; a <= 0.6; a += 0.015)
            for (double b = -0.2; b <= 0.2; b += 0.015)
                add(samples, kOrigin + (std::abs(4 * a) < hole ? 8.0 : 4.0) *
                                           Eigen::Vector3d(1, a, b));
        return RayImage(samples, kOrigin);
    };
    const Eigen::Vector3d mean = kOrigin + Eigen::Vector3d(4, 0, 0);
    const Gaussian<3> sheet = plate(mean, {0.01, 0.6, 0.2}),
                      bush = plate(mean, {0.2, 0.6, 0.2});
    EXPECT_FALSE(seenFrom(sheet, wallWith(0.7)));
    EXPECT_TRUE(seenFrom(sheet, wallWith(1.3)));
    EXPECT_TRUE(seenFrom(bush, wallWith(0.7)));
}

TEST(SeenThrough, NotWhatRaysOnlyPassBeside) {
    // No ray goes through the core of a pole, and one beside it ends near.
    Mixture<3> samples;
    for (double a = -0.5; a <= 0.5; a += 0.02)
        add(samples, kOrigin + 8 * Eigen::Vector3d(1, a + 0.01, 0));
    add(samples, kOrigin + Eigen::Vector3d(2.98, 0.08, 0));
    const RayImage image(samples, kOrigin);
    EXPECT_FALSE(
        seenFrom(plate(kOrigin + Eigen::Vector3d(3, 0, 0), {0.02, 0.02, 0.1}), image));
}

TEST(SeenThrough, NotWhatIsMostlyHidden) {
    // A wall that reaches from y = -inf to the middle of the component only.
    Mixture<3> samples;
    for (double a = -1; a <= 1; a += 0.015)
        for (double b = -1; b <= 1; b += 0.015)
            add(samples, kOrigin + (a < 0.05 ? 2.0 : 8.0) * Eigen::Vector3d(1, a, b));
    const RayImage image(samples, kOrigin);
    EXPECT_FALSE(
        seenFrom(plate(kOrigin + Eigen::Vector3d(4, 0.2, 0), {0.01, 0.5, 0.1}), image));
    EXPECT_TRUE(
        seenFrom(plate(kOrigin + Eigen::Vector3d(4, 2, 0), {0.01, 0.3, 0.1}), image));
    EXPECT_FALSE(seenFrom(plate(kOrigin, {0.1, 0.1, 0.1}), image));
}

TEST(CoarseGrid, AgreesWithBruteForceThroughMovesAndRemovals) {
    std::mt19937_64 engine(2);
    CoarseGrid grid;
    std::vector<Eigen::Vector3d> means;
    const auto randomPoint = [&] {
        return Eigen::Vector3d(Eigen::Vector3d(uniform(engine, -90, 90),
                                               uniform(engine, -90, 90),
                                               uniform(engine, -10, 10))
                                   .cast<float>()
                                   .cast<double>());
    };
    for (int step = 0; step < 2000; ++step) {
        // Every other step adds, so that the grid fills.
        const auto i = static_cast<std::uint32_t>(
            step % 2 == 0 ? means.size() : engine() % (means.size() + 1));
        if (step % 3 == 2 && i < means.size()) {
            const auto last = static_cast<std::uint32_t>(means.size() - 1);
            grid.remove(last, means[last].cast<float>());
            if (i < last) grid.move(i, means[i].cast<float>(), means[last].cast<float>());
            means[i] = means[last];
            means.pop_back();
        } else if (i == means.size()) {
            means.push_back(randomPoint());
            grid.add(i, means[i].cast<float>());
        } else {
            const Eigen::Vector3d before = means[i];
            means[i] = randomPoint();
            grid.move(i, before.cast<float>(), means[i].cast<float>());
        }
        if (step % 20 != 0 || means.empty()) continue;
        const Eigen::Vector3d a = randomPoint(),
                              b = randomPoint() * (step % 40 ? 1.0 : 1e12);
        const Eigen::Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b);
        const auto found = grid.within(low, high);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
        for (std::uint32_t k = 0; k < means.size(); ++k) {
            const bool inside =
                (means[k].array() >= low.array() && means[k].array() <= high.array()).all();
            const bool near = (means[k].array() >= low.array() - 8 &&
                               means[k].array() <= high.array() + 8)
                                  .all();
            const auto count = std::count(found.begin(), found.end(), k);
            EXPECT_LE(count, near ? 1 : 0);
            EXPECT_GE(count, inside ? 1 : 0);
        }
    }
    EXPECT_GT(means.size(), 100U);
}

TEST(Contradiction, ParametersOutOfRangeAreNamed) {
    CarvingParams params;
    params.carvedSupport = 0;
    EXPECT_THROW(params.validate(), std::invalid_argument);
    params = {};
    params.minSupport = -1;
    EXPECT_THROW(params.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
