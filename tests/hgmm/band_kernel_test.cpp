#include "occupancy/band_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace hgmm::bands {
namespace {

struct Cases {
    Lanes lanes{};
    float point[3] = {}, rest[3] = {};
};

/// Surfaces of 1 to 50 mm, 0 to 60 of their thicknesses and 0 to 5 m away, some of them
/// seen from afar.
Cases someCases(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> unit(0.F, 1.F);
    std::normal_distribution<float> normal;
    Cases cases;
    for (int d = 0; d < 3; ++d) {
        cases.point[d] = 100.F * normal(engine);
        cases.rest[d] = 1e-6F * normal(engine);
    }
    Lanes& l = cases.lanes;
    for (int k = 0; k < kBlock; ++k) {
        const float thickness = 0.001F * std::pow(50.F, unit(engine));
        const float extent = 0.05F + unit(engine);
        const float away = (k % 2 == 0 ? 60.F * thickness : 5.F) * normal(engine);
        for (int d = 0; d < 3; ++d)
            l.mean[d][k] = cases.point[d] + (d == 2 ? away : extent * normal(engine));
        l.factor[0][k] = l.factor[2][k] = 1.F / extent;
        l.factor[1][k] = 0.3F / extent;
        l.factor[3][k] = 0.1F / thickness * normal(engine);
        l.factor[4][k] = 0.1F / thickness * normal(engine);
        l.factor[5][k] = 1.F / thickness;
        const float view[3] = {0.3F * normal(engine), 0.3F * normal(engine), 1.F};
        const float length =
            std::sqrt(view[0] * view[0] + view[1] * view[1] + view[2] * view[2]);
        for (int row = 0, entry = 0; row < 3; ++row)
            for (int col = 0; col <= row; ++col)
                l.view[row][k] += l.factor[entry++][k] * view[col] / length;
        for (int d = 0; d < 3; ++d) l.precision[k] += l.view[d][k] * l.view[d][k];
        l.tau[k] = 1.F / std::sqrt(l.precision[k]);
        l.peak[k] = 100.F * unit(engine);
        l.sharpness[k] = 2.F;
        l.reach[k] = 3.F * unit(engine);
        l.width[k] = 0.1F;
        l.freePerMetre[k] = 1.F;
    }
    return cases;
}

bool sameBits(const float* a, const float* b, int n) {
    return std::memcmp(a, b, sizeof(float) * std::size_t(n)) == 0;
}

TEST(BandKernel, HasTheSameBitsWithAnyInstructionSet) {
    const Kernel& first = *kernels().front();
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const Cases cases = someCases(seed);
        const int n = int(seed) % kBlock + 1;
        Places places{};
        Densities densities{};
        first.place(cases.lanes, n, cases.point, cases.rest, places);
        first.evaluate(cases.lanes, places, n, 3e-4F, densities);
        for (const Kernel* other : kernels()) {
            Places otherPlaces{};
            Densities otherDensities{};
            other->place(cases.lanes, n, cases.point, cases.rest, otherPlaces);
            other->evaluate(cases.lanes, otherPlaces, n, 3e-4F, otherDensities);
            ASSERT_TRUE(sameBits(places.beside, otherPlaces.beside, n)) << other->name;
            ASSERT_TRUE(sameBits(places.height, otherPlaces.height, n)) << other->name;
            for (const auto member :
                 {&Densities::occupied, &Densities::known, &Densities::freeAtHits,
                  &Densities::freePassed, &Densities::meanW, &Densities::meanSquaredW})
                ASSERT_TRUE(sameBits(densities.*member, otherDensities.*member, n))
                    << other->name << ", seed " << seed;
        }
    }
}

TEST(BandKernel, FindsTheLanesNearAPoint) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const Cases cases = someCases(seed);
        const float* const p = cases.point;
        const int n = int(seed) % kBlock + 1;
        std::mt19937 engine(seed);
        std::uniform_real_distribution<float> unit(0.F, 1.F);
        Boxes boxes{};
        Bodies bodies{};
        for (int k = 0; k < kBlock; ++k)
            for (int d = 0; d < 3; ++d) {
                boxes.centre[d][k] = bodies.mean[d][k] = cases.lanes.mean[d][k];
                boxes.halfExtent[d][k] = 2.F * unit(engine);
                bodies.factor[d][k] = unit(engine);
                bodies.factor[d + 3][k] = unit(engine);
            }
        LaneSet inside = 0, near = 0, within = 0;
        Places all{};
        kernels().front()->place(cases.lanes, kBlock, p, cases.rest, all);
        float squared[kBlock] = {};
        for (int k = 0; k < n; ++k) {
            float beside[3], row[3] = {};
            bool holds = true;
            for (int d = 0; d < 3; ++d) {
                beside[d] = p[d] - boxes.centre[d][k];
                holds &= std::abs(beside[d]) <= boxes.halfExtent[d][k];
            }
            for (int r = 0, entry = 0; r < 3; ++r)
                for (int c = 0; c <= r; ++c)
                    row[r] += bodies.factor[entry++][k] * beside[c];
            squared[k] = row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
            const LaneSet bit = LaneSet{1} << unsigned(k);
            if (holds) inside |= bit;
            if (holds && all.beside[k] <= 16.F) near |= bit;
            if (squared[k] <= 2.F) within |= bit;
        }
        for (const Kernel* kernel : kernels()) {
            Places places{};
            alignas(32) float found[kBlock] = {};
            EXPECT_EQ(kernel->inside(boxes, n, p), inside) << kernel->name;
            EXPECT_EQ(kernel->placeNear(cases.lanes, inside, p, cases.rest, 16.F, places),
                      near)
                << kernel->name;
            for (int k = 0; k < n; ++k) {
                if ((inside >> unsigned(k) & 1U) == 0) continue;
                EXPECT_TRUE(sameBits(&places.beside[k], &all.beside[k], 1));
                EXPECT_TRUE(sameBits(&places.height[k], &all.height[k], 1));
            }
            EXPECT_EQ(kernel->within(bodies, n, p, 2.F, found), within) << kernel->name;
            EXPECT_TRUE(sameBits(found, squared, n)) << kernel->name;
        }
    }
}

/// Where a point is, by squares in long double.
void placeOf(const Cases& c, int k, long double& beside, long double& height) {
    long double w[3] = {}, squared = 0, along = 0, precision = 0;
    for (int row = 0, entry = 0; row < 3; ++row) {
        for (int col = 0; col <= row; ++col)
            w[row] += static_cast<long double>(c.lanes.factor[entry++][k]) *
                      (static_cast<long double>(c.point[col]) - c.lanes.mean[col][k] +
                       c.rest[col]);
        const long double v = c.lanes.view[row][k];
        squared += w[row] * w[row], along += v * w[row], precision += v * v;
    }
    height = along / precision;
    beside = squared - along * along / precision;
}

TEST(BandKernel, FindsThePlaceOfAPointFarFromThinSurfaces) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const Cases cases = someCases(seed);
        Places places{};
        kernel().place(cases.lanes, kBlock, cases.point, cases.rest, places);
        for (int k = 0; k < kBlock; ++k) {
            long double beside = 0, height = 0;
            placeOf(cases, k, beside, height);
            if (beside > 16) continue;
            EXPECT_NEAR(double(places.beside[k]), double(beside), 0.02) << "seed " << seed;
            EXPECT_NEAR(double(places.height[k]), double(height),
                        1e-5 + 1e-5 * std::abs(double(height)))
                << "seed " << seed;
        }
    }
}

TEST(BandKernel, AgreesWithTheFunctionsOfTheCLibrary) {
    const double cut = std::exp(-8.0), root = std::sqrt(0.5), twoPi = 6.283185307179586;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const Cases cases = someCases(seed);
        Places at{};
        Densities said{};
        kernel().place(cases.lanes, kBlock, cases.point, cases.rest, at);
        kernel().evaluate(cases.lanes, at, kBlock, float(cut), said);
        for (int k = 0; k < kBlock; ++k) {
            const Lanes& l = cases.lanes;
            const double beside = at.beside[k], t = at.height[k], tau = l.tau[k];
            if (beside > 16 || std::abs(t) > 8 * tau) continue;
            const double a = -t / tau, b = (double(l.reach[k]) - t) / tau;
            const double hit = std::exp(-0.5 * a * a);
            const double occupied = double(l.peak[k]) * std::exp(-0.5 * beside) * hit;
            EXPECT_NEAR(double(said.occupied[k]), occupied, 3e-5 * occupied);
            const double known =
                std::max(std::exp(-0.5 * double(l.sharpness[k]) * beside) * hit - cut, 0.0);
            EXPECT_NEAR(double(said.known[k]), known, 3e-5);
            const double mass = a > 0 ? 0.5 * (std::erfc(a * root) - std::erfc(b * root))
                                      : 0.5 * (std::erfc(-b * root) - std::erfc(-a * root));
            const double fall = t > double(l.width[k]) ? double(l.width[k]) / t : 1.0;
            const double free = double(l.peak[k]) * std::exp(-0.5 * beside) * mass * tau *
                                std::sqrt(twoPi) * double(l.freePerMetre[k]) * fall;
            EXPECT_NEAR(double(said.freeAtHits[k]) + double(said.freePassed[k]), free,
                        1e-4 * free + 1e-6 * double(l.peak[k]));
            EXPECT_GE(said.meanW[k], 0.F);
            EXPECT_LE(said.meanW[k], l.reach[k]);
            EXPECT_GE(said.meanSquaredW[k] * 1.0001F, said.meanW[k] * said.meanW[k]);
        }
    }
}

TEST(BandKernel, TakesZeroAndTheFarTailForWhatTheyAre) {
    alignas(32) float squared[8] = {0.F, 1e-20F, 1.F, 16.F, 119.F, 121.F, 1e10F, 3e38F};
    kernel().normalFall(squared, 8);
    EXPECT_EQ(squared[0], 1.F);
    EXPECT_EQ(squared[1], 1.F);
    EXPECT_NEAR(squared[2], std::exp(-0.5F), 1e-6F);
    EXPECT_NEAR(squared[3], std::exp(-8.F), 1e-9F);
    EXPECT_GT(squared[4], 0.F);
    for (int k = 5; k < 8; ++k) EXPECT_EQ(squared[k], 0.F);
}

}  // namespace
}  // namespace hgmm::bands
