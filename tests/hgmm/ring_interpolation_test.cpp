#include "scan/ring_interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::uniform;

constexpr double kNoise_m = 0.005;

Gaussian<3> sampleAt(double x, double y, double z) {
    Gaussian<3> s;
    s.support = 1;
    s.mean << x, y, z;
    s.covariance = kNoise_m * kNoise_m * Eigen::Matrix3d::Identity();
    return s;
}

void add(Mixture<3>& samples, double x, double y, double z) {
    samples.pushBack(sampleAt(x, y, z));
}

/// How many samples of `after` have grown.
std::size_t grown(const Mixture<3>& before, const Mixture<3>& after) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        count += before[i].covariance != after[i].covariance;
    return count;
}

TEST(Gaps, RingsOnAWallMeet) {
    Mixture<3> samples;
    // Within one octave of cell sizes: at the borders of octaves a few samples stay alone.
    for (const double z : {0.3, 0.9})
        for (int i = 0; i < 37; ++i) add(samples, 5.0, 0.02 * i + 0.01, z);
    interpolateRings(samples, {});
    samples.check();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Gaussian<3> s = samples[i];
        // Across the line and in the wall by half the spread of the rings, 0.3 m; neither
        // along the line nor off the wall.
        EXPECT_NEAR(std::sqrt(s.covariance(2, 2)), 0.15, 0.002);
        EXPECT_NEAR(std::sqrt(s.covariance(0, 0)), kNoise_m, 1e-4);
        EXPECT_NEAR(std::sqrt(s.covariance(1, 1)), kNoise_m, 1e-3);
        EXPECT_EQ(s.support, 1);
    }
}

TEST(Gaps, DenseImagesAreLeftAlone) {
    Mixture<3> samples;
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 100; ++j)
            add(samples, 2.0, 0.02 * i - 1 + 0.01, 0.02 * j - 1 + 0.01);
    const Mixture<3> before = samples;
    interpolateRings(samples, {});
    EXPECT_EQ(samples, before);
}

TEST(Gaps, LonelyPointsAreLeftAlone) {
    for (const int points : {1, 2}) {
        Mixture<3> samples;
        for (int i = 0; i < points; ++i) add(samples, 5, 0.1 + 0.05 * i, 0.1);
        const Mixture<3> before = samples;
        interpolateRings(samples, {});
        EXPECT_EQ(samples, before);
    }
    Mixture<3> none;
    interpolateRings(none, {});
    EXPECT_TRUE(none.empty());
}

TEST(Gaps, ALineAloneIsLeftAlone) {
    Mixture<3> samples;
    for (int i = 0; i < 300; ++i) add(samples, 8, 0.02 * i - 3, 0.3);
    const Mixture<3> before = samples;
    interpolateRings(samples, {});
    EXPECT_EQ(samples, before);
}

// All of a planar laser's points lie in a plane, that of its rays, which is no surface:
// walls would be as thick as the corner beside them.
TEST(Gaps, ThePlaneOfTheRaysIsNoSurface) {
    for (const double tilt : {0.0, 0.3}) {
        Mixture<3> samples;
        for (int i = 0; i < 200; ++i) {
            const double along = 0.02 * i, up = std::sin(tilt);
            add(samples, 5.3, along, 5.3 * up);
            add(samples, 1.3 + along, 3.7, (1.3 + along) * up);
        }
        const Mixture<3> before = samples;
        interpolateRings(samples, {});
        EXPECT_EQ(samples, before);
    }
}

// The rings of a lidar on the ground under it meet far out, where rays are nearly level.
/// Ends of a lidar's rays, 1 m above the floor: a table edge 3.4 m away lies on one ring;
/// the rings above and below go to the floor or to a wall, 8 m away.
TEST(Gaps, ATableTopIsNotJoinedWithTheFloorBehindIt) {
    constexpr double kPi = 3.14159265358979;
    Mixture<3> samples, edge;
    for (int ring = -8; ring < 8; ++ring)
        for (int i = -30; i <= 30; ++i) {
            const double rise = std::tan((2 * ring + 1) * kPi / 180),
                         azimuth = i * kPi / 360;
            const bool meetsTable = ring == -3;
            const double range = meetsTable ? 3.4
                                 : rise < 0 ? std::min(8.0, -1 / rise)
                                            : 8.0;
            (meetsTable ? edge : samples)
                .pushBack(sampleAt(range * std::cos(azimuth), range * std::sin(azimuth),
                                   range * rise));
        }
    const std::size_t others = samples.size();
    for (std::size_t i = 0; i < edge.size(); ++i) samples.pushBack(edge[i]);
    interpolateRings(samples, {});
    for (std::size_t i = others; i < samples.size(); ++i)
        EXPECT_LT(std::sqrt(samples[i].covariance(2, 2)), 0.03) << i;
}

TEST(Gaps, GroundSeenAtASmallAngleIsASurface) {
    Mixture<3> samples;
    for (const double range : {29.0, 31.0, 33.0, 35.0})
        for (int i = -200; i < 200; ++i)
            add(samples, range * std::cos(0.002 * i), range * std::sin(0.002 * i), -1.0);
    const Mixture<3> before = samples;
    interpolateRings(samples, {});
    EXPECT_GT(grown(before, samples), samples.size() / 2);
}

TEST(Gaps, VegetationIsLeftAlone) {
    // A bush of 4 m: so thin that cells hold few samples each.
    std::mt19937_64 engine(1);
    std::size_t changed = 0, all = 0;
    for (const int points : {200, 2000, 20000}) {
        Mixture<3> samples;
        for (int i = 0; i < points; ++i)
            add(samples, uniform(engine, 8, 12), uniform(engine, -2, 2),
                uniform(engine, -2, 2));
        const Mixture<3> before = samples;
        interpolateRings(samples, {});
        std::cout << "gaps: " << grown(before, samples) << " of " << points
                  << " samples in a bush grew\n";
        changed += grown(before, samples);
        all += samples.size();
    }
    EXPECT_LT(double(changed), 0.03 * double(all));
}

TEST(Gaps, DoNotDependOnTheOrderOfSamples) {
    Mixture<3> samples, reversed;
    for (const double z : {0.3, 0.9})
        for (int i = 0; i < 100; ++i) add(samples, 5.0, 0.03 * i + 0.01, z);
    for (std::size_t i = samples.size(); i-- > 0;) reversed.pushBack(samples[i]);
    interpolateRings(samples, {});
    interpolateRings(reversed, {});
    for (std::size_t i = 0; i < samples.size(); ++i)
        EXPECT_TRUE(samples[i].covariance.isApprox(
            reversed[samples.size() - 1 - i].covariance, 1e-5));
}

}  // namespace
}  // namespace hgmm
