#include "occupancy/free_space.h"

#include <gtest/gtest.h>

#include <set>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::uniform;

const Eigen::Vector3d kSensor(0.3, -0.2, 1.1);

/// Bundles on the inside of a hall, at ranges of 3 to 60 m.
std::vector<RayBundle> hall(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<RayBundle> bundles;
    for (int i = 0; i < 400; ++i) {
        RayBundle b;
        b.support = std::floor(uniform(engine, 1, 50));
        b.mean = {uniform(engine, -60, 60), uniform(engine, -20, 20), 0.0};
        if (i % 2 == 0)
            b.mean = {b.mean.x(), i % 4 == 0 ? 20.0 : -20.0, uniform(engine, 0, 5)};
        b.covariance.diagonal() << 0.04, 0.04, 0.04;
        if (i % 2 != 0)
            b.covariance(2, 2) = 1e-4;
        else
            b.covariance(1, 1) = 1e-4;
        if ((b.mean - kSensor).norm() > 3) bundles.push_back(b);
    }
    return bundles;
}

SurfacePyramid clearanceOf(const std::vector<RayBundle>& bundles) {
    SurfacePyramid pyramid;
    for (const RayBundle& bundle : bundles) pyramid.add(bundle.mean.cast<float>());
    return pyramid;
}

FreeSpace filled(int scans, const FreeSpaceParams& params = {}) {
    FreeSpace space;
    for (int s = 0; s < scans; ++s) {
        const auto bundles = hall(s % 7);
        space.insert(bundles, kSensor, clearanceOf(bundles), {}, params);
    }
    return space;
}

TEST(FreeSpace, SupportsContinueThoseOfTheBands) {
    const FreeSpaceBandParams band;
    double expected = 0;
    for (const RayBundle& b : hall(0)) {
        const double range = (b.mean - kSensor).norm();
        // The integral of freePerMetre width / w from the band's reach to the sensor.
        const double end = range - 0.05;
        expected += b.support * band.freePerMetre(range) * band.width(range) *
                    std::log(end / band.reach(range));
    }
    EXPECT_NEAR(filled(1).mixture().totalSupport(), expected, 1e-4 * expected);
}

TEST(FreeSpace, ComponentsKeepToTheirCells) {
    const FreeSpace space = filled(5);
    space.mixture().check();
    ASSERT_GT(space.mixture().size(), 50U);
    std::set<std::array<int, 4>> cells;
    std::set<int> octaves;
    for (std::size_t i = 0; i < space.mixture().size(); ++i) {
        const Gaussian<4> g = space.mixture()[i];
        const LatticeCell cell = LatticeCell::at(g.mean.head<3>(), space.octave(i));
        EXPECT_TRUE(cells.insert({cell.octave, cell.x, cell.y, cell.z}).second) << "shared";
        octaves.insert(cell.octave);
        // Means of slabs lie within the cell; a slab is half its edge, a bundle 0.2 m.
        const double edge = std::ldexp(1.0, cell.octave);
        for (int d = 0; d < 3; ++d)
            EXPECT_LT(std::sqrt(g.covariance(d, d)), 0.55 * edge + 0.22);
        EXPECT_GT(g.mean[3], 0);
        EXPECT_LE(std::ldexp(1.0, cell.octave), 2 * g.mean[3] + 1.0);
    }
    EXPECT_GE(octaves.size(), 4U);
}

TEST(FreeSpace, IsDeterministicAndReportsWhatChanged) {
    EXPECT_TRUE(filled(4) == filled(4));
    FreeSpace space = filled(1);
    const FreeSpace before = space;
    const auto bundles = hall(3);
    const auto changed =
        space.insert(bundles, kSensor, clearanceOf(bundles), {}, FreeSpaceParams());
    EXPECT_TRUE(std::is_sorted(changed.begin(), changed.end()));
    const std::set<std::uint32_t> said(changed.begin(), changed.end());
    EXPECT_EQ(said.size(), changed.size());
    for (std::uint32_t i = 0; i < space.mixture().size(); ++i) {
        const bool isNew = i >= before.mixture().size();
        const bool differs =
            isNew || space.mixture().support[i] != before.mixture().support[i];
        EXPECT_EQ(said.count(i) == 1, differs);
    }
}

TEST(FreeSpace, CoarsenedKeepsMomentsAndShrinks) {
    const FreeSpace space = filled(5);
    const auto moments = [](const Mixture<4>& m) {
        Gaussian<4> all = m[0];
        for (std::size_t i = 1; i < m.size(); ++i) all = mergeMoments(all, m[i]);
        return all;
    };
    const Gaussian<4> all = moments(space.mixture());
    EXPECT_EQ(space.coarsened(0).size(), space.mixture().size());
    std::size_t last = space.mixture().size();
    for (const int times : {1, 3, 6}) {
        const Mixture<4> coarse = space.coarsened(times);
        coarse.check();
        EXPECT_LT(coarse.size(), last);
        last = coarse.size();
        const Gaussian<4> same = moments(coarse);
        EXPECT_NEAR(same.support / all.support, 1, 1e-5);
        EXPECT_TRUE(same.mean.isApprox(all.mean, 1e-4));
        EXPECT_TRUE(same.covariance.isApprox(all.covariance, 1e-3));
    }
}

TEST(FreeSpace, SettledCellsLearnNoMore) {
    FreeSpaceParams params;
    params.freeSettledScans = 4;
    const auto bundles = hall(1);
    const SurfacePyramid pyramid = clearanceOf(bundles);
    FreeSpace space;
    space.insert(bundles, kSensor, pyramid, {}, params);
    const double one = space.mixture().totalSupport();
    for (int s = 1; s < 4; ++s) space.insert(bundles, kSensor, pyramid, {}, params);
    EXPECT_NEAR(space.mixture().totalSupport(), 4 * one, 0.3 * one);
    for (int s = 0; s < 20; ++s) space.insert(bundles, kSensor, pyramid, {}, params);
    EXPECT_LE(space.mixture().totalSupport(), 5.01 * one);
    EXPECT_TRUE(space.insert(bundles, kSensor, pyramid, {}, params).empty());
}

TEST(FreeSpace, CellsShrinkNearSurfaces) {
    // One ray of 16 m through the open, and the same ray over a floor.
    RayBundle ray;
    ray.support = 10;
    ray.mean << 16, 0.3, 0.3;
    ray.covariance = 1e-2 * Eigen::Matrix3d::Identity();
    SurfacePyramid open, floor;
    open.add(ray.mean.cast<float>());
    for (double x = 0; x < 16; x += 0.25)
        for (double y = -1; y < 1.5; y += 0.25) floor.add({float(x), float(y), 0.05F});
    const auto cells = [&](const SurfacePyramid& pyramid) {
        FreeSpace space;
        FreeSpaceParams params;
        params.freeCellAtOneMetre_m = 0.4;
        space.insert({ray}, {0, 0.3, 0.3}, pyramid, {}, params);
        return space.mixture().size();
    };
    EXPECT_LT(cells(open), 12U);
    EXPECT_GT(cells(floor), cells(open) + 2);
}

TEST(FreeSpace, ShortRaysAddNothing) {
    RayBundle ray;
    ray.support = 10;
    ray.mean << 0.4, 0, 0;
    ray.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    FreeSpace space;
    EXPECT_TRUE(space.insert({ray}, {0, 0, 0}, clearanceOf({ray}), {}, {}).empty());
    ray.mean.setZero();
    EXPECT_TRUE(space.insert({ray}, {0, 0, 0}, clearanceOf({ray}), {}, {}).empty());
    EXPECT_TRUE(space.mixture().empty());
}

}  // namespace
}  // namespace hgmm
