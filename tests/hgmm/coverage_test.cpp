#include "occupancy/coverage.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "base/dual.h"
#include "base/lattice_walk.h"
#include "hgmm/map.h"
#include "io/coverage_codec.h"
#include "io/coverage_words.h"
#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;
using test::uniform;

Eigen::Vector3d randomPoint(std::mt19937_64& engine, double extent) {
    Eigen::Vector3d p;
    for (int d = 0; d < 3; ++d) p[d] = uniform(engine, -extent, extent);
    return p;
}

/// A cone of rays of 0.3 rad to each side of the x axis, from the origin.
Coverage coneOfRays(double range_m, double spacing_rad, bool isHit = true) {
    const Coverage::Rays rays({}, spacing_rad, Eigen::Vector3d::Zero());
    Coverage coverage;
    for (double a = -0.3; a <= 0.3; a += spacing_rad)
        for (double b = -0.3; b <= 0.3; b += spacing_rad)
            coverage.markRay(
                Eigen::Vector3d::Zero(),
                range_m * Eigen::Vector3d(1.0, std::tan(a), std::tan(b)).normalized(),
                isHit, rays);
    return coverage;
}

TEST(WalkCells, VisitsTheCellsOfASegmentInOrder) {
    std::mt19937_64 engine(1);
    for (int trial = 0; trial < 200; ++trial) {
        const Eigen::Vector3d from = randomPoint(engine, 5), to = randomPoint(engine, 5);
        const double perCell = uniform(engine, 0.5, 8);
        std::set<std::array<std::int32_t, 3>> visited;
        double last = 0;
        walkCells(from, to, perCell, [&](const std::int32_t* c, double in, double out) {
            EXPECT_EQ(in, last);
            EXPECT_GE(out, in);
            last = out;
            visited.insert({c[0], c[1], c[2]});
            const Eigen::Vector3d middle = from + (in + out) / 2 * (to - from);
            for (int d = 0; d < 3; ++d) {
                EXPECT_GE(middle[d] * perCell, c[d] - 1e-9);
                EXPECT_LE(middle[d] * perCell, c[d] + 1 + 1e-9);
            }
        });
        EXPECT_EQ(last, 1.0);
        for (double t = 0; t <= 1; t += 1e-3) {
            const Eigen::Vector3d p = (from + t * (to - from)) * perCell;
            const Eigen::Vector3d inside = p.array() - p.array().floor();
            if (inside.minCoeff() < 1e-6 || inside.maxCoeff() > 1 - 1e-6) continue;
            EXPECT_TRUE(
                visited.count({floorToInt(p.x()), floorToInt(p.y()), floorToInt(p.z())}));
        }
    }
}

TEST(WalkCells, IgnoresWhatIsNotFiniteOrTooFar) {
    int visits = 0;
    const auto count = [&](const std::int32_t*, double, double) { ++visits; };
    walkCells(Eigen::Vector3d::Zero(), {0, NAN, 0}, 1.0, count);
    walkCells(Eigen::Vector3d::Zero(), {INFINITY, 0, 0}, 1.0, count);
    walkCells(Eigen::Vector3d::Zero(), {1e12, 0, 0}, 1.0, count);
    EXPECT_EQ(visits, 0);
    walkCells(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 1.0, count);
    EXPECT_EQ(visits, 1);
}

TEST(Coverage, IsOneWhereRaysAreDenseAndZeroWhereTheyAreNot) {
    for (const double range : {2.0, 6.0, 30.0}) {
        const double spacing = range < 10 ? 0.01 : 0.004;
        const Coverage coverage = coneOfRays(range, spacing);
        std::mt19937_64 engine(2);
        for (int i = 0; i < 500; ++i) {
            const double w = uniform(engine, 0.3, 1.2 * range);
            const double edge = 1.5 * 0.08 * std::sqrt(std::max(w, 0.5));
            const double a = uniform(engine, -0.6, 0.6), b = uniform(engine, -0.25, 0.25);
            const Eigen::Vector3d p =
                w * Eigen::Vector3d(1, std::tan(a), std::tan(b)).normalized();
            const double beside = w * (std::abs(a) - 0.3);
            const double c = coverage.at(p.data());
            if (w < range - 2 * edge && beside < -2 * edge) {
                EXPECT_GT(c, 0.99) << range << " m, at " << p.transpose();
            }
            if (w > range + edge || beside > 2 * edge) {
                EXPECT_EQ(c, 0.0) << range << " m, at " << p.transpose();
            }
        }
    }
}

TEST(Coverage, RaysThatClearReachTheirEnd) {
    const Coverage hits = coneOfRays(5.0, 0.01), cleared = coneOfRays(5.0, 0.01, false);
    const Eigen::Vector3d nearEnd(4.97, 0.01, 0.02);
    EXPECT_LT(hits.at(nearEnd.data()), 0.7);
    EXPECT_GT(cleared.at(nearEnd.data()), 0.2);
    EXPECT_GT(cleared.at(nearEnd.data()), hits.at(nearEnd.data()));
}

TEST(Coverage, HasTheGradientOfItsDifferences) {
    const Coverage coverage = coneOfRays(4.0, 0.02);
    std::mt19937_64 engine(3);
    constexpr double h = 1e-6;
    int slopes = 0;
    for (int i = 0; i < 2000; ++i) {
        Eigen::Vector3d p(uniform(engine, 0.2, 4.5), uniform(engine, -1.6, 1.6),
                          uniform(engine, -1.6, 1.6));
        const Dual x[3] = {{p.x(), Eigen::Vector3d::UnitX()},
                           {p.y(), Eigen::Vector3d::UnitY()},
                           {p.z(), Eigen::Vector3d::UnitZ()}};
        const Dual c = coverage.at(x);
        EXPECT_EQ(c.value, coverage.at(p.data()));
        for (int d = 0; d < 3; ++d) {
            Eigen::Vector3d low = p, high = p;
            low[d] -= h;
            high[d] += h;
            const double a = coverage.at(low.data()), b = coverage.at(high.data());
            // Continuous: a cell's edge is 0.0625 m at least, and (tri)^2 has slope 2 /
            // edge.
            EXPECT_LE(std::abs(b - a), 2 * h * 2 / 0.0625 + 1e-12);
            const double ahead = (b - c.value) / h, behind = (c.value - a) / h;
            if (std::abs(ahead - behind) > 1e-3) continue;  // a kink between them
            EXPECT_NEAR(c.gradient[d], (b - a) / (2 * h), 1e-4);
            slopes += std::abs(c.gradient[d]) > 0.1;
        }
    }
    EXPECT_GT(slopes, 150);
}

TEST(Coverage, HoldsAPlanarLasersPlaneAtAnyHeight) {
    for (double height = -0.2; height < 0.2; height += 0.013) {
        const Coverage::Rays rays({}, 0.01, Eigen::Vector3d::UnitZ());
        Coverage coverage;
        const Eigen::Vector3d origin(0.1, 0.2, height);
        for (double a = 0; a < 6.28; a += 0.01)
            coverage.markRay(origin, origin + 5 * Eigen::Vector3d(cos(a), sin(a), 0), true,
                             rays);
        const Eigen::Vector3d p(2.3, -1.7, height), above(2.3, -1.7, height + 0.4);
        EXPECT_GT(coverage.at(p.data()), 0.55) << height;
        EXPECT_EQ(coverage.at(above.data()), 0.0) << height;
    }
}

TEST(Coverage, BridgesTheGapsOfASparseSensorButNotWideOnes) {
    const Coverage coverage = coneOfRays(25.0, 0.03);
    int known = 0, near = 0;
    std::mt19937_64 engine(4);
    for (int i = 0; i < 1000; ++i) {
        const double w = uniform(engine, 3, 8);
        const Eigen::Vector3d p =
            w * Eigen::Vector3d(1, uniform(engine, -0.2, 0.2), uniform(engine, -0.2, 0.2))
                    .normalized();
        ++near;
        known += coverage.at(p.data()) > 0.5;
    }
    EXPECT_GT(known, 0.98 * near);
    // Half way between four rays of 0.75 m spacing.
    const double far = 24.0;
    const Eigen::Vector3d between(far, far * 0.015, far * 0.015);
    EXPECT_LT(coverage.at(between.data()), 0.5);
}

TEST(Coverage, MergesAtAnyPoseWithoutHoles) {
    const Coverage coverage = coneOfRays(4.0, 0.01);
    Coverage same;
    same.merge(coverage, {});
    EXPECT_TRUE(same == coverage);

    Pose T;
    T.R = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    T.t = {3.3, -1.21, 0.77};
    Coverage turned;
    turned.merge(coverage, T);
    std::mt19937_64 engine(5);
    for (int i = 0; i < 1000; ++i) {
        const Eigen::Vector3d p(uniform(engine, 0.5, 3.6), uniform(engine, -0.1, 0.1),
                                uniform(engine, -0.1, 0.1));
        const Eigen::Vector3d q = T.R * p + T.t;
        EXPECT_GT(turned.at(q.data()), 0.99) << p.transpose();
        const Eigen::Vector3d beside =
            T.R * (p + Eigen::Vector3d(0, 0.35 * p.x() + 0.5, 0)) + T.t;
        EXPECT_EQ(turned.at(beside.data()), 0.0);
    }
}

TEST(Coverage, PrunedSaysTheSameOnceAndForAll) {
    Coverage coverage = coneOfRays(9.0, 0.01);
    const Coverage::Rays rays({}, 0.01, Eigen::Vector3d::Zero());
    for (double y = -1; y < 1; y += 0.03)  // from afar, where cells are larger
        coverage.markRay({30, y, 0.1}, {1.0, y, 0.1}, true, rays);
    const Coverage pruned = coverage.pruned();
    EXPECT_TRUE(pruned.pruned() == pruned);
    EXPECT_LE(pruned.blockCount(), coverage.blockCount());
    std::mt19937_64 engine(6);
    for (int i = 0; i < 3000; ++i) {
        const Eigen::Vector3d p(uniform(engine, 0, 10), uniform(engine, -3, 3),
                                uniform(engine, -3, 3));
        EXPECT_NEAR(pruned.at(p.data()), coverage.at(p.data()), 0.35);
        EXPECT_EQ(pruned.at(p.data()) > 0.5, coverage.at(p.data()) > 0.5);
    }
}

/// Random blocks in several octaves, far from each other.
Coverage randomCoverage(std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Coverage coverage;
    for (int i = 0; i < 200; ++i) {
        const auto at = [&] { return static_cast<std::int32_t>(engine() % 2000) - 1000; };
        const int octave = static_cast<int>(engine() % 4) - 3;
        const std::int32_t x = at(), y = at(), z = at();
        coverage.mark(LatticeCell{octave, x, y, z}, engine() & engine());
    }
    return coverage;
}

TEST(CoverageCodec, RoundTripIsExact) {
    for (const Coverage& coverage :
         {Coverage(), coneOfRays(6.0, 0.02), randomCoverage(1), randomCoverage(2)}) {
        for (const auto encode : {encodeCoverage, writeCoverage}) {
            std::vector<std::uint8_t> bytes;
            encode(coverage, bytes);
            const std::size_t size = bytes.size();
            bytes.insert(bytes.end(), 10, 0xAA);
            Coverage decoded;
            EXPECT_EQ(decodeCoverage(bytes.data(), bytes.size(), decoded), size);
            EXPECT_TRUE(decoded == coverage);
            EXPECT_EQ(decoded.octaves(), coverage.octaves());
        }
    }
}

TEST(CoverageCodec, EqualCoveragesArePlainlyWrittenAlike) {
    const Coverage coverage = randomCoverage(3);
    Coverage otherOrder;
    std::vector<std::pair<LatticeCell, Coverage::Word>> blocks;
    coverage.forEachBlock(
        [&](const LatticeCell& b, Coverage::Word word) { blocks.emplace_back(b, word); });
    for (auto b = blocks.rbegin(); b != blocks.rend(); ++b)
        otherOrder.mark(b->first, b->second);
    std::vector<std::uint8_t> bytes, others;
    writeCoverage(coverage, bytes);
    writeCoverage(otherOrder, others);
    EXPECT_EQ(bytes, others);
}

TEST(CoverageCodec, TakesAThirdOfTheBits) {
    const Coverage coverage = coneOfRays(8.0, 0.01);
    std::vector<std::uint8_t> bytes;
    encodeCoverage(coverage, bytes);
    EXPECT_LT(bytes.size(), coverage.blockCount() * 8 / 3);
}

TEST(CoverageCodec, DamageIsAnErrorOrAnotherCoverage) {
    const auto decode = [](const std::vector<std::uint8_t>& data) {
        Coverage decoded;
        try {
            decodeCoverage(data.data(), data.size(), decoded);
        } catch (const std::runtime_error&) {
        } catch (const std::out_of_range&) {
        }
    };
    for (const auto encode : {encodeCoverage, writeCoverage}) {
        std::vector<std::uint8_t> bytes;
        encode(coneOfRays(3.0, 0.05), bytes);
        std::mt19937_64 engine(7);
        for (int trial = 0; trial < 300; ++trial) {
            std::vector<std::uint8_t> damaged = bytes;
            damaged[engine() % damaged.size()] ^= 1U << engine() % 8;
            decode(damaged);
            damaged.resize(engine() % damaged.size());
            decode(damaged);
        }
    }
}

}  // namespace
}  // namespace hgmm
