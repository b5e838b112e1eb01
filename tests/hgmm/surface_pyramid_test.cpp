#include "index/surface_pyramid.h"

#include <gtest/gtest.h>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::uniform;

Eigen::Vector3d randomPoint(std::mt19937_64& engine) {
    Eigen::Vector3d p;
    for (int d = 0; d < 3; ++d) p[d] = float(uniform(engine, -10, 10));
    return p;
}

/// By definition: the cell and its six neighbours.
bool nearByHand(const std::vector<Eigen::Vector3d>& means, const LatticeCell& cell) {
    for (const Eigen::Vector3d& mean : means) {
        const LatticeCell m = LatticeCell::at(mean, cell.octave);
        if (std::abs(m.x - cell.x) + std::abs(m.y - cell.y) + std::abs(m.z - cell.z) <= 1)
            return true;
    }
    return false;
}

void expectAgreement(const SurfacePyramid& pyramid,
                     const std::vector<Eigen::Vector3d>& means, std::mt19937_64& engine) {
    int near = 0, clear = 0;
    for (int q = 0; q < 400; ++q) {
        const int octave = static_cast<int>(engine() % 13) + SurfacePyramid::kMinOctave;
        const LatticeCell cell = LatticeCell::at(randomPoint(engine), octave);
        const bool expected = nearByHand(means, cell);
        EXPECT_EQ(pyramid.isNearSurface(cell), expected);
        ++(expected ? near : clear);
    }
    EXPECT_GT(near, 20);
    EXPECT_GT(clear, 20);
}

TEST(SurfacePyramid, AgreesWithBruteForceThroughMovesAndRemovals) {
    std::mt19937_64 engine(1);
    SurfacePyramid pyramid;
    std::vector<Eigen::Vector3d> means;
    for (int i = 0; i < 150; ++i) {
        means.push_back(randomPoint(engine));
        pyramid.add(means.back().cast<float>());
    }
    expectAgreement(pyramid, means, engine);
    for (int step = 0; step < 10; ++step) {
        for (int k = 0; k < 30; ++k) {
            const auto i = static_cast<std::uint32_t>(engine() % means.size());
            // Small moves stay in the larger cells, large ones leave all.
            const double reach = k % 2 == 0 ? 0.1 : 10;
            const Eigen::Vector3d before = means[i];
            means[i] += reach / 10 * randomPoint(engine);
            for (int d = 0; d < 3; ++d) means[i][d] = float(means[i][d]);
            pyramid.move(before.cast<float>(), means[i].cast<float>());
        }
        for (int k = 0; k < 10; ++k) {
            const auto i = static_cast<std::uint32_t>(engine() % means.size());
            pyramid.remove(means[i].cast<float>());
            means[i] = means.back();
            means.pop_back();
        }
        expectAgreement(pyramid, means, engine);
    }
    for (const Eigen::Vector3d& mean : means) pyramid.remove(mean.cast<float>());
    for (int octave = SurfacePyramid::kMinOctave; octave <= SurfacePyramid::kMaxOctave;
         ++octave)
        EXPECT_FALSE(pyramid.isNearSurface(LatticeCell::at({0, 0, 0}, octave)));
}

TEST(SurfacePyramid, AsksTheParentOfWhatIsTooSmallAndClearsNothingTooLarge) {
    SurfacePyramid pyramid(-1);
    pyramid.add({0.9F, 0.4F, 0.4F});
    EXPECT_TRUE(pyramid.isNearSurface(LatticeCell::at({0.1, 0.1, 0.1}, -4)));
    EXPECT_FALSE(pyramid.isNearSurface(LatticeCell::at({-0.1, 0.1, 0.1}, -4)));
    EXPECT_FALSE(pyramid.isNearSurface(LatticeCell::at({0.1, -0.6, 0.1}, -1)));
    EXPECT_TRUE(pyramid.isNearSurface({SurfacePyramid::kMaxOctave + 5, 99, 0, 0}));
}

TEST(LatticeCell, HoldsItsPoint) {
    EXPECT_TRUE((LatticeCell::at({-0.1, 0.1, 5.9}, 1) == LatticeCell{1, -1, 0, 2}));
    EXPECT_TRUE((LatticeCell::at({-0.1, 0.1, 5.9}, -1) == LatticeCell{-1, -1, 0, 11}));
    EXPECT_TRUE((LatticeCell::at({1e300, -1e300, 0}, 0) ==
                 LatticeCell{0, 1000000000, -1000000000, 0}));
}

}  // namespace
}  // namespace hgmm
