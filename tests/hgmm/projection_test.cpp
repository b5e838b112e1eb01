#include "hgmm/projection.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::uniform;

constexpr double kSigmas = 2.4;

/// A component given by its principal axes (columns, the first is the normal) and standard
/// deviations: its surface is known without solving for them.
struct Patch {
    Eigen::Vector3d mean, sigmas;
    Eigen::Matrix3d axes;

    Gaussian<3> component() const {
        Gaussian<3> g;
        g.support = 10;
        g.mean = mean;
        g.covariance = axes * sigmas.cwiseAbs2().asDiagonal() * axes.transpose();
        return g;
    }
    Eigen::Vector3d at(double u, double v) const {
        return mean + kSigmas * (u * sigmas[1] * axes.col(1) + v * sigmas[2] * axes.col(2));
    }
    Eigen::Vector3d projection(const Eigen::Vector3d& p) const {
        const Eigen::Vector3d offset = axes.transpose() * (p - mean);
        const auto kept = [&](int a) {
            return std::clamp(offset[a] / (kSigmas * sigmas[a]), -1.0, 1.0);
        };
        return at(kept(1), kept(2));
    }
    double squaredMahalanobis(const Eigen::Vector3d& p, double softening) const {
        const Eigen::Vector3d offset = axes.transpose() * (p - mean);
        double sum = 0;
        for (int a = 0; a < 3; ++a)
            sum += offset[a] * offset[a] / (sigmas[a] * sigmas[a] + softening * softening);
        return sum;
    }
};

/// Patches in a cube of 8 m, from thin walls to near-round clutter. Upright ones have one
/// tangent along z and stand on the floor's outline of a 2D map.
std::vector<Patch> patches(std::size_t n, bool upright, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Patch> result;
    while (result.size() < n) {
        Patch p;
        for (int d = 0; d < 3; ++d) p.mean[d] = uniform(random, -4, 4);
        p.sigmas[0] = uniform(random, 0.002, 0.1);
        p.sigmas[1] = p.sigmas[0] + uniform(random, 0.05, 0.3);
        p.sigmas[2] = p.sigmas[1] + uniform(random, 0.05, 0.5);
        p.axes = Eigen::AngleAxisd(uniform(random, -3, 3), Eigen::Vector3d::UnitZ())
                     .toRotationMatrix();
        if (!upright)
            p.axes = p.axes * Eigen::AngleAxisd(uniform(random, -3, 3),
                                                Eigen::Vector3d(uniform(random, -1, 1),
                                                                uniform(random, -1, 1), 0.5)
                                                    .normalized())
                                  .toRotationMatrix();
        result.push_back(p);
    }
    return result;
}

Mixture<3> mixtureOf(const std::vector<Patch>& patches) {
    Mixture<3> mixture;
    for (const Patch& p : patches) mixture.pushBack(p.component());
    return mixture;
}

Eigen::Vector3d somewhere(std::mt19937_64& random) {
    return {uniform(random, -6, 6), uniform(random, -6, 6), uniform(random, -6, 6)};
}

template <int D>
typename SurfaceProjection<D>::Point pointOf(const Eigen::Vector3d& p) {
    typename SurfaceProjection<D>::Point point;
    for (int d = 0; d < D; ++d) point[d] = float(p[d]);
    return point;
}

Eigen::Vector3d vectorOf(const std::array<float, 3>& p) {
    return {p[0], p[1], p[2]};
}

Patch wall() {
    // Across x at x = 1, 1 m wide and 0.5 m high.
    Patch p{{1, 0, 0}, {0.01, 0.5, 1.0}, {}};
    p.axes << 1, 0, 0, 0, 0, 1, 0, 1, 0;  // columns x, z, y
    return p;
}

TEST(SurfaceProjection, FootOfAWallIsWorkedOutByHand) {
    const SurfaceProjection<3> surface(mixtureOf({wall()}));
    struct Case {
        Eigen::Vector3d point, projection;
    };
    for (const auto& c :
         {Case{{1.3, 0.5, 0.2}, {1, 0.5, 0.2}}, Case{{0.9, -2.3, 1.1}, {1, -2.3, 1.1}},
          Case{{1.0, 5.0, 0.0}, {1, 2.4, 0}}, Case{{1.5, -3.0, 2.0}, {1, -2.4, 1.2}}}) {
        const auto projection = surface.nearest(pointOf<3>(c.point));
        ASSERT_TRUE(projection);
        EXPECT_LT((vectorOf(projection->point) - c.projection).norm(), 1e-5)
            << c.point.transpose();
        EXPECT_NEAR(projection->squaredDistance_m2, (c.point - c.projection).squaredNorm(),
                    1e-5);
        const auto likely = surface.mostLikely(pointOf<3>(c.point), 5.F);
        ASSERT_TRUE(likely);
        EXPECT_EQ(likely->point, projection->point);
    }
}

TEST(SurfaceProjection, NearestFootIsThatOfDenselySampledSurfaces) {
    constexpr int steps = 40;
    const auto all = patches(60, false, 1);
    const SurfaceProjection<3> surfaces(mixtureOf(all));
    ASSERT_EQ(surfaces.size(), all.size());
    std::mt19937_64 random(2);
    for (int k = 0; k < 60; ++k) {
        const Eigen::Vector3d p = somewhere(random);
        double sampled = std::numeric_limits<double>::infinity();
        for (const Patch& patch : all)
            for (int i = -steps; i <= steps; ++i)
                for (int j = -steps; j <= steps; ++j)
                    sampled = std::min(
                        sampled,
                        (patch.at(double(i) / steps, double(j) / steps) - p).norm());
        const auto projection = surfaces.nearest(pointOf<3>(p));
        ASSERT_TRUE(projection);
        const double distance = std::sqrt(projection->squaredDistance_m2);
        EXPECT_LE(distance, sampled + 1e-5);
        EXPECT_GE(distance, sampled - 0.05) << "half the diagonal of the samples' cells";
        EXPECT_NEAR((vectorOf(projection->point) - p).norm(), distance, 1e-5);
        EXPECT_LT(
            (all[projection->component].projection(p) - vectorOf(projection->point)).norm(),
            1e-4);
    }
}

TEST(SurfaceProjection, InThePlaneSurfacesAreSegmentsAtAnyHeight) {
    constexpr int steps = 1000;
    const auto all = patches(60, true, 3);
    const SurfaceProjection<2> surfaces(mixtureOf(all));
    std::mt19937_64 random(4);
    for (int k = 0; k < 60; ++k) {
        const Eigen::Vector3d p = somewhere(random);
        double sampled = std::numeric_limits<double>::infinity();
        for (const Patch& patch : all)
            for (int i = -steps; i <= steps; ++i)
                sampled = std::min(sampled,
                                   (patch.at(double(i) / steps, 0) - p).head<2>().norm());
        const auto projection = surfaces.nearest(pointOf<2>(p));
        ASSERT_TRUE(projection);
        EXPECT_NEAR(std::sqrt(projection->squaredDistance_m2), sampled, 1e-3);
        EXPECT_NEAR(std::hypot(projection->point[0] - p.x(), projection->point[1] - p.y()),
                    sampled, 1e-3);
    }
}

TEST(SurfaceProjection, MostLikelyIsThatOfBruteForce) {
    const auto all = patches(300, false, 5);
    const SurfaceProjection<3> surfaces(mixtureOf(all));
    std::mt19937_64 random(6);
    int found = 0, notNearest = 0;
    for (int k = 0; k < 2000; ++k) {
        const Eigen::Vector3d p = somewhere(random);
        const double radius = uniform(random, 0.05, 1.5);
        std::size_t best = all.size();
        double likeliest = std::numeric_limits<double>::infinity();
        bool close = false;  // a decision within rounding
        for (std::size_t j = 0; j < all.size(); ++j) {
            const double distance = (all[j].projection(p) - p).norm();
            close |= std::abs(distance - radius) < 1e-4;
            if (distance >= radius) continue;
            const double d2 = all[j].squaredMahalanobis(
                p, SurfaceProjection<3>::kKernelWidthPerRadius * radius);
            close |= std::abs(d2 - likeliest) < 1e-3 * likeliest;
            if (d2 < likeliest) {
                likeliest = d2;
                best = j;
            }
        }
        if (close) continue;
        const auto projection = surfaces.mostLikely(pointOf<3>(p), float(radius));
        ASSERT_EQ(projection.has_value(), best < all.size());
        if (!projection) continue;
        ++found;
        EXPECT_EQ(projection->component, best);
        EXPECT_LT((all[best].projection(p) - vectorOf(projection->point)).norm(), 1e-4);
        notNearest += surfaces.nearest(pointOf<3>(p))->component != best;
    }
    EXPECT_GT(found, 500);
    EXPECT_GT(notNearest, 20) << "or nearest() would do";
}

TEST(SurfaceProjection, FarSurfacesChangeNothing) {
    const auto near = patches(100, false, 7);
    auto larger = near;
    for (Patch p : patches(900, false, 8)) {
        p.mean.x() += 100;
        larger.push_back(p);
    }
    const SurfaceProjection<3> a(mixtureOf(near)), b(mixtureOf(larger));
    std::mt19937_64 random(9);
    for (int k = 0; k < 300; ++k) {
        const auto p = pointOf<3>(somewhere(random));
        EXPECT_EQ(a.nearest(p)->point, b.nearest(p)->point);
        const auto inA = a.mostLikely(p, 0.5F), inB = b.mostLikely(p, 0.5F);
        ASSERT_EQ(inA.has_value(), inB.has_value());
        if (inA) {
            EXPECT_EQ(inA->component, inB->component);
        }
    }
}

TEST(SurfaceProjection, RadiusIsALimitAndMustBePositive) {
    const SurfaceProjection<3> surface(mixtureOf({wall()}));
    EXPECT_TRUE(surface.mostLikely({1.3F, 0.F, 0.F}, 0.31F));
    EXPECT_FALSE(surface.mostLikely({1.3F, 0.F, 0.F}, 0.29F));
    for (const float radius : {0.F, -1.F, std::numeric_limits<float>::quiet_NaN()})
        EXPECT_FALSE(surface.mostLikely({1.F, 0.F, 0.F}, radius)) << radius;
}

TEST(SurfaceProjection, EqualSurfacesGoByIndex) {
    const SurfaceProjection<3> surfaces(mixtureOf(std::vector<Patch>(50, wall())));
    for (float y = -3; y <= 3; y += 0.5F)
        EXPECT_EQ(surfaces.mostLikely({1.2F, y, 0.F}, 1.F)->component, 0U);
}

TEST(SurfaceProjection, HostileInputGivesNothingOrFiniteFeet) {
    const SurfaceProjection<3> empty, none{Mixture<3>()}, surface(mixtureOf({wall()}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(empty.nearest({0.F, 0.F, 0.F}));
    EXPECT_FALSE(none.mostLikely({0.F, 0.F, 0.F}, 1.F));
    for (const float bad : {nan, infinity, -infinity, 3e38F}) {
        EXPECT_FALSE(surface.nearest({bad, 0.F, 0.F})) << bad;
        EXPECT_FALSE(surface.mostLikely({0.F, bad, 0.F}, 1.F)) << bad;
    }
    Mixture<3> degenerate;
    Gaussian<3> g;
    g.support = 1;
    g.mean << 1, 2, 3;
    degenerate.pushBack(g);  // a point
    g.covariance(0, 0) = -1e-9;
    degenerate.pushBack(g);  // not positive definite
    g.mean.x() = nan;
    degenerate.pushBack(g);
    const SurfaceProjection<3> points(degenerate);
    EXPECT_EQ(points.size(), 2U);
    const auto projection = points.nearest({1.F, 2.F, 5.F});
    ASSERT_TRUE(projection);
    EXPECT_NEAR(projection->squaredDistance_m2, 4.F, 1e-5);
}

}  // namespace
}  // namespace hgmm
