#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/evaluation/gp_octomap_baseline.h"
#include "voxel_centres.h"
#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Calls f with the low corner of each cube within [low, high).
void forCubes(const Vector3d& low, const Vector3d& high, double edge_m,
              const std::function<void(const Vector3d&)>& f) {
    const Eigen::Array3i n = ((high - low) / edge_m).array().round().cast<int>();
    for (int i = 0; i < n.x(); ++i)
        for (int j = 0; j < n.y(); ++j)
            for (int k = 0; k < n.z(); ++k) f(low + edge_m * Vector3d(i, j, k));
}

/// Whether all voxels of a cube are known and of one mind, and the mean of what they know.
struct Agreement {
    Agreement(const GpOctomapBaseline& map, const Vector3d& low, double edge_m, double p) {
        int voxels = 0, occupied = 0, free = 0;
        double vector = 0.0, precision = 0.0;
        forVoxels(low, low + Vector3d::Constant(edge_m), [&](const Vector3d& x) {
            const Answer answer = ask(map, x.x(), x.y(), x.z());
            ++voxels;
            occupied += answer.probability >= p ? 1 : 0;
            free += answer.probability <= 1 - p ? 1 : 0;
            const GpBelief belief = map.beliefAt(x);
            vector += belief.mean / belief.variance;
            precision += 1.0 / belief.variance;
        });
        agree = occupied == voxels || free == voxels;
        mean = {vector / precision, voxels / precision};
    }

    bool agree;
    GpBelief mean;
};

}  // namespace

TEST(GpOctomap, AWallSeenOnce) {
    GpOctomapBaseline map(0.1);
    EXPECT_TRUE(ask(map, kWall_m).unknown) << "nothing was seen yet";
    map.insert(wallScan());
    for (const auto& [y, z] : {std::pair{0.53, 0.73}, {1.2, 0.2}, {-0.3, 1.5}}) {
        EXPECT_FALSE(ask(map, kWall_m, y, z).unknown);
        EXPECT_GT(ask(map, kWall_m, y, z).probability, 0.6);
    }
    for (double x = 1.1; x < 2.8; x += 0.1) {
        EXPECT_FALSE(ask(map, x).unknown) << x;
        EXPECT_LT(ask(map, x).probability, 0.45) << x;
    }
    // Behind the wall, behind the sensor, beside the rays.
    for (const Answer& answer : {ask(map, 3.45), ask(map, 3.75), ask(map, 0.55),
                                 ask(map, 1.2, 1.6), ask(map, 1.0e6)}) {
        EXPECT_TRUE(answer.unknown);
        EXPECT_EQ(answer.probability, 0.5);
    }
}

TEST(GpOctomap, AnswersFollowFromTheBelief) {
    GpOctomapParams p = GpOctomapParams::atResolution(0.1);
    p.maxKnownVariance = 0.1;
    p.minVariance = 0.02;  // as large as lets a few scans reach it
    GpOctomapBaseline map(p);
    map.insert(wallScan());
    int known = 0, unknown = 0;
    forVoxels({0.8, -0.6, -0.4}, {3.6, 1.7, 1.9}, [&](const Vector3d& x) {
        const GpBelief belief = map.beliefAt(x);
        const Answer answer = ask(map, x.x(), x.y(), x.z());
        ASSERT_GE(belief.variance, p.minVariance * 0.999);
        ASSERT_LE(belief.variance, 0.25 * 1.001);
        ASSERT_EQ(answer.unknown, belief.variance > p.maxKnownVariance);
        ++(answer.unknown ? unknown : known);
        const double evidence = belief.mean / belief.variance * p.minVariance;
        ASSERT_LE(std::abs(evidence), 1.001);
        const double wanted = answer.unknown ? 0.5 : 1 / (1 + std::exp(-p.gain * evidence));
        ASSERT_NEAR(answer.probability, wanted, 1e-4);
    });
    EXPECT_GT(known, 1000);
    EXPECT_GT(unknown, 1000);
    for (int i = 0; i < 20; ++i) map.insert(wallScan());
    EXPECT_NEAR(map.beliefAt({3.05, 0.55, 0.75}).variance, p.minVariance, 1e-6);
}

/// The beliefs of voxels that agree are replaced by their mean, in blocks of eight that
/// agree, and of eight of those.
TEST(GpOctomap, VoxelsThatAgreeAreMerged) {
    GpOctomapParams p = GpOctomapParams::atResolution(0.1);
    p.mergeProbability = 1.0 - 1e-15;
    GpOctomapBaseline apart(p);
    p.mergeProbability = 0.58;
    GpOctomapBaseline merged(p);
    const std::size_t empty = merged.liveBytes();
    merged.insert(wallScan());
    apart.insert(wallScan());
    int mergedBlocks = 0, mergedCubes = 0;
    forCubes({0.4, -0.8, -0.8}, {3.6, 2.0, 2.0}, 0.4, [&](const Vector3d& block) {
        const Agreement whole(apart, block, 0.4, p.mergeProbability);
        mergedBlocks += whole.agree ? 1 : 0;
        forCubes(block, block + Vector3d::Constant(0.4), 0.2, [&](const Vector3d& cube) {
            const Agreement part(apart, cube, 0.2, p.mergeProbability);
            mergedCubes += part.agree && !whole.agree ? 1 : 0;
            forVoxels(cube, cube + Vector3d::Constant(0.2), [&](const Vector3d& x) {
                const GpBelief is = merged.beliefAt(x);
                const GpBelief wanted = whole.agree  ? whole.mean
                                        : part.agree ? part.mean
                                                     : apart.beliefAt(x);
                EXPECT_NEAR(is.mean, wanted.mean, 1e-5) << x.transpose();
                EXPECT_NEAR(is.variance, wanted.variance, 1e-6) << x.transpose();
            });
        });
    });
    EXPECT_GT(mergedBlocks, 5);
    EXPECT_GT(mergedCubes, 50);
    // A voxel has at least two floats.
    EXPECT_GT(merged.liveBytes(), empty);
    EXPECT_LT(merged.liveBytes() + 8 * (63 * mergedBlocks + 7 * mergedCubes),
              apart.liveBytes());
}

TEST(GpOctomap, PointsThatTeachNothingAreLeftOut) {
    GpOctomapBaseline clean(0.1), dirty(0.1);
    hgmm::Scan scan = wallScan();
    clean.insert(scan);
    scan.pushBack(std::nanf(""), 0, 0);
    scan.pushBack(0, std::numeric_limits<float>::infinity(), 0);
    scan.pushBack(0, 0, 0);
    scan.pushBack(1e30F, 0, 0);
    dirty.insert(scan);
    dirty.insert(hgmm::Scan{});
    EXPECT_EQ(clean.liveBytes(), dirty.liveBytes());
    forVoxels({0.8, -0.6, -0.4}, {3.6, 1.7, 1.9}, [&](const Vector3d& x) {
        EXPECT_EQ(clean.beliefAt(x).mean, dirty.beliefAt(x).mean);
        EXPECT_EQ(clean.beliefAt(x).variance, dirty.beliefAt(x).variance);
    });
    for (const double x : {std::nan(""), kInfinity, -kInfinity, 1e300})
        EXPECT_TRUE(ask(dirty, x).unknown);
}

TEST(GpOctomap, EvidenceThatContradictsItselfStaysFinite) {
    GpOctomapParams p = GpOctomapParams::atResolution(0.1);
    p.noise = 1e-3 * p.sigmaF;
    p.sampleSpacing_m = 0.001;
    p.freeSpacing_m = 0.001;
    hgmm::Scan scan;  // its free samples coincide with its hits
    for (int i = 1; i <= 300; ++i) scan.pushBack(0.001F * static_cast<float>(i), 0, 0);
    GpOctomapBaseline map(p);
    for (int i = 0; i < 3; ++i) map.insert(scan);
    forVoxels({-0.4, -0.4, -0.4}, {0.8, 0.4, 0.4}, [&](const Vector3d& x) {
        const Answer answer = ask(map, x.x(), x.y(), x.z());
        EXPECT_TRUE(answer.probability >= 0.0 && answer.probability <= 1.0);
        EXPECT_TRUE(std::isfinite(map.beliefAt(x).mean));
    });
}

TEST(GpOctomap, ParametersAreChecked) {
    const double nan = std::nan("");
    using Change = std::function<void(GpOctomapParams&)>;
    const std::vector<std::pair<std::string, Change>> wrong{
        {"resolution_m", [](auto& p) { p.resolution_m = 0.0; }},
        {"length_m", [](auto& p) { p.length_m = -1.0; }},
        {"sigmaF", [&](auto& p) { p.sigmaF = nan; }},
        {"noise", [](auto& p) { p.noise = 0.9e-3 * p.sigmaF; }},
        {"minVariance", [](auto& p) { p.minVariance = 0.0; }},
        {"maxKnownVariance", [](auto& p) { p.maxKnownVariance = 0.26; }},
        {"maxKnownVariance", [](auto& p) { p.maxKnownVariance = 0.9 * p.minVariance; }},
        {"gain", [](auto& p) { p.gain = kInfinity; }},
        {"mergeProbability", [](auto& p) { p.mergeProbability = 0.5; }},
        {"mergeProbability", [](auto& p) { p.mergeProbability = 1.0; }},
        {"freeSpacing_m", [](auto& p) { p.freeSpacing_m = 0.0; }},
        {"sampleSpacing_m", [&](auto& p) { p.sampleSpacing_m = nan; }},
        {"blockDepth", [](auto& p) { p.blockDepth = 0; }},
        {"blockDepth", [](auto& p) { p.blockDepth = 5; }},
        {"maxBlockPoints", [](auto& p) { p.maxBlockPoints = 0; }},
        {"maxBlockPoints", [](auto& p) { p.maxBlockPoints = 4001; }}};
    for (const auto& [field, change] : wrong) {
        GpOctomapParams p;
        change(p);
        try {
            GpOctomapBaseline map(p);
            ADD_FAILURE() << field << " was accepted";
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find(field), std::string::npos) << e.what();
        }
    }
    for (const double resolution_m : {0.0, -0.1, nan, kInfinity})
        EXPECT_THROW(GpOctomapBaseline{resolution_m}, std::invalid_argument);
}

TEST(GpOctomap, TellsItsOptions) {
    const GpOctomapBaseline map(0.15);
    const auto options = map.options();
    EXPECT_EQ(options.at(0), (std::pair<std::string, double>("resolution", 0.15)));
    EXPECT_EQ(options.at(1), (std::pair<std::string, double>("length", 0.3)));
    EXPECT_EQ(options.at(2), (std::pair<std::string, double>("sigmaF", 0.5)));
    EXPECT_EQ(map.meaning(), Meaning::occupancy);
    EXPECT_NE(map.source().find("Wang"), std::string::npos);
}
