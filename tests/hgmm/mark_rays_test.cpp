#include "occupancy/mark_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::uniform;

const Pose kMarkingSensor{Eigen::Matrix3d::Identity(), {0.31, -0.17, 0.23}};

/// What the rays to hits mark together, and what each marks alone.
struct Marks {
    Coverage together, alone;

    Marks(const std::vector<Eigen::Vector3d>& hits, double raySpacing_rad) {
        Mixture<3> samples;
        const Coverage::Rays rays({}, raySpacing_rad, Eigen::Vector3d::Zero());
        for (const Eigen::Vector3d& hit : hits) {
            samples.pushBack({1.0, hit, Eigen::Matrix3d::Identity() * 1e-4});
            alone.markRay(kMarkingSensor.t, samples.meanAt(samples.size() - 1), true, rays);
        }
        ScanSamples scan;
        scan.raySpacing_rad = raySpacing_rad;
        markRays(samples, scan, kMarkingSensor, {}, together);
    }
};

Eigen::Vector3d hitAt(double range_m, double a, double b) {
    return kMarkingSensor.t +
           range_m * Eigen::Vector3d(1, std::tan(a), std::tan(b)).normalized();
}

TEST(MarkRays, WalksRaysThatAreFarApartWhole) {
    std::vector<Eigen::Vector3d> hits;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0)
                    hits.push_back(kMarkingSensor.t +
                                   (9 + x + y) *
                                       Eigen::Vector3d(x, y + 0.1, z).normalized());
    const Marks marks(hits, 0.02);
    EXPECT_TRUE(marks.together == marks.alone);
}

TEST(MarkRays, LeavesNoHolesAmongRaysThatAreNear) {
    std::mt19937_64 engine(1);
    std::vector<Eigen::Vector3d> hits;
    for (double a = -0.4; a <= 0.4; a += 0.006)
        for (double b = -0.3; b <= 0.3; b += 0.006)
            hits.push_back(hitAt(uniform(engine, 11.9, 12.1), a, b));
    const Marks marks(hits, 0.006);
    marks.together.forEachBlock([&](const LatticeCell& block, Coverage::Word cells) {
        EXPECT_EQ(cells & ~marks.alone.word(block), 0U);
    });
    int lost = 0;
    for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector3d p =
            hitAt(uniform(engine, 0.1, 11.5), uniform(engine, -0.38, 0.38),
                  uniform(engine, -0.28, 0.28));
        lost += marks.alone.at(p.data()) == 1.0 && marks.together.at(p.data()) < 0.5;
    }
    EXPECT_LT(lost, 20);  // one in a thousand, between rays that bins tell apart
}

TEST(MarkRays, FollowsALongRayBesideAShortOne) {
    const Eigen::Vector3d shortHit = hitAt(3, 0, 0), longHit = hitAt(14, 0.001, 0.001);
    for (const bool longFirst : {false, true}) {
        const Marks marks(
            longFirst ? std::vector{longHit, shortHit} : std::vector{shortHit, longHit},
            0.001);
        for (double range_m = 0.5; range_m < 13.7; range_m += 0.05) {
            const Eigen::Vector3d p = hitAt(range_m, 0.001, 0.001);
            EXPECT_GT(marks.together.shareAt(p.data()), 0.1) << range_m;
        }
        const Eigen::Vector3d behind = hitAt(15, 0.001, 0.001);
        EXPECT_EQ(marks.together.shareAt(behind.data()), 0.0);
    }
}

}  // namespace
}  // namespace hgmm
