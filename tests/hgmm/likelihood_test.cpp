#include "hgmm/likelihood.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace hgmm {
namespace {

Mixture<3> wallAndPost() {
    Mixture<3> mixture;
    Gaussian<3> wall;
    wall.support = 1000;
    wall.covariance.diagonal() << 0.0001, 1.0, 1.0;
    mixture.pushBack(wall);
    Gaussian<3> post;
    post.support = 10;
    post.mean << 1.0, 0.0, 0.0;
    post.covariance.diagonal() << 0.01, 0.01, 1.0;
    mixture.pushBack(post);
    return mixture;
}

/// p at the squared distance to the nearest patch.
double probabilityAt(double squaredDistance, double outlierRatio) {
    const auto tail = [](double squared) { return 1 / (1 + 0.5 * squared); };
    // Where the tail adds half of the outlier ratio, or at 20, it has been lowered to 0.
    const double end = std::max(outlierRatio / (2 - outlierRatio), tail(400));
    return outlierRatio +
           (1 - outlierRatio) * std::max(0.0, (tail(squaredDistance) - end) / (1 - end));
}

/// Sum over the axes of one patch, by trying a fine grid of points on it.
double squaredDistance(const Gaussian<3>& g, const Eigen::Vector3d& point,
                       double softening) {
    const Eigen::Matrix3d covariance = g.covariance;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Matrix3d axes = solver.eigenvectors();
    const double s2 = softening * softening;
    const Eigen::Vector3d apart = axes.transpose() * (point - g.mean);
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
        const double own = solver.eigenvalues()[a], least = solver.eigenvalues()[0];
        const double aspect = std::sqrt(own / solver.eigenvalues()[2]);
        const double along = a == 0 ? 0.0 : std::clamp(8 * aspect - 1, 0.0, 1.0);
        const double half = std::sqrt(3 * own * along);
        const double variance =
            least + (1 - along) * (own - least) + s2 * std::pow(s2 / (s2 + half * half), 2);
        double best = std::numeric_limits<double>::infinity();
        constexpr int steps = 2000;
        for (int u = -steps; u <= steps; ++u)
            best = std::min(best, std::pow(apart[a] - u * half / steps, 2) / variance);
        sum += best;
    }
    return sum;
}

Mixture<3> tiltedPatches(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto vector = [&] {
        return Eigen::Vector3d(normal(random), normal(random), normal(random));
    };
    Mixture<3> mixture;
    for (int i = 0; i < n; ++i) {
        const Eigen::Matrix3d axes = Eigen::Quaterniond(normal(random), normal(random),
                                                        normal(random), normal(random))
                                         .normalized()
                                         .toRotationMatrix();
        Gaussian<3> g;
        g.support = 1 + i;
        g.mean = vector();
        // Rectangles, lines, and what is between them.
        const Eigen::Vector3d sigma(0.01, i % 2 == 0 ? 0.1 : 0.04, 0.2 + 0.1 * (i % 3));
        g.covariance = axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
        mixture.pushBack(g);
    }
    return mixture;
}

TEST(SurfaceLikelihood, IsItsFormula) {
    const Mixture<3> mixture = tiltedPatches(8, 1);
    std::mt19937 random(2);
    std::normal_distribution<double> normal(0, 0.15);
    int onIt = 0, beside = 0;
    for (const double outliers : {1e-4, 0.05, 0.5}) {
        const SurfaceLikelihood likelihood(mixture, 0.1, outliers);
        for (std::size_t i = 0; i < 80; ++i) {
            const Eigen::Vector3d p =
                mixture[i % 8].mean +
                Eigen::Vector3d(normal(random), normal(random), normal(random));
            double squared = std::numeric_limits<double>::infinity();
            for (std::size_t j = 0; j < 8; ++j)
                squared = std::min(squared, squaredDistance(mixture[j], p, 0.1));
            const double expected = probabilityAt(squared, outliers);
            const Eigen::Vector3f f = p.cast<float>();
            const double actual = likelihood.probability(f.x(), f.y(), f.z());
            EXPECT_NEAR(actual, expected, 0.001) << squared;  // the grid of the oracle
            EXPECT_DOUBLE_EQ(likelihood(f.x(), f.y(), f.z()), std::log(actual));
            if (squared < 1) ++onIt;
            if (squared > 4 && squared < 25) ++beside;
        }
    }
    EXPECT_GT(onIt, 20);
    EXPECT_GT(beside, 10);
}

// The Gaussian of the same width is flat there: nothing would lead back to the wall.
TEST(SurfaceLikelihood, LeadsBackFromSeveralWidthsAway) {
    const SurfaceLikelihood likelihood(wallAndPost(), 0.02, 0.05);
    const double width = std::hypot(0.01, 0.02);
    for (double off = 0; off < 8; off += 0.5)
        EXPECT_GT(likelihood(float(-off * width), 0, 0),
                  likelihood(float(-(off + 0.5) * width), 0, 0) + 0.005)
            << off;
    Mixture<3> wall;
    wall.pushBack(wallAndPost()[0]);
    const SurfaceLikelihood unforgiving(wall, 0.02, 1e-9);
    EXPECT_GT(unforgiving(float(-19.9 * width), 0, 0), std::log(1e-9) + 1);
    EXPECT_EQ(unforgiving(float(-20.1 * width), 0, 0), std::log(1e-9));
    // The tail ends without a step.
    EXPECT_NEAR(likelihood(float(-8.7 * width), 0, 0), std::log(0.05), 0.02);
    EXPECT_EQ(likelihood(float(-8.9 * width), 0, 0), std::log(0.05));
    for (float x = float(-8.9 * width); x < float(-8.6 * width); x += 1e-6F)
        ASSERT_GE(likelihood(x, 0, 0), std::log(0.05)) << x;
}

// Gaussians in place of patches would fall to a fifth halfway between two of them.
TEST(SurfaceLikelihood, IsTheSameAllAlongAWallOfPieces) {
    Mixture<3> wall;
    const double length = 0.5;
    for (int i = 0; i < 20; ++i) {
        Gaussian<3> piece;
        piece.support = 10;
        piece.mean << i * length, 0, 0;
        piece.covariance.diagonal() << length * length / 12, 1e-4, 1e-4;
        wall.pushBack(piece);
    }
    const SurfaceLikelihood likelihood(wall, 0.1, 0.05);
    for (const float y : {0.F, 0.05F, 0.15F}) {
        const double expected = likelihood(0, y, 0);
        for (float x = 0; x < 9.5F; x += 0.037F)
            EXPECT_NEAR(likelihood(x, y, 0), expected, 1e-4) << x << " " << y;
    }
}

// Points of a wall's next piece, not mapped yet, must not be drawn back to the end of what
// is mapped.
TEST(SurfaceLikelihood, EndsOfLongPiecesAreSharp) {
    Mixture<3> wall;
    Gaussian<3> piece;
    piece.support = 10;
    piece.covariance.diagonal() << 0.25 / 3, 1e-4, 1e-4;  // from -0.5 to 0.5
    wall.pushBack(piece);
    const SurfaceLikelihood likelihood(wall, 0.1, 0.05);
    EXPECT_NEAR(likelihood(0.49F, 0, 0), 0, 1e-3);
    EXPECT_NEAR(likelihood(0.6F, 0, 0), std::log(0.05), 0.03);
    // Across it, and above the line that a planar laser draws, all of the softening counts.
    for (const double off : {0.05, 0.1}) {
        const double expected = std::log(probabilityAt(100 * off * off, 0.05));
        EXPECT_NEAR(likelihood(0, float(off), 0), expected, 0.15);
        EXPECT_NEAR(likelihood(0, 0, float(off)), expected, 0.15);
    }
}

// The thinnest direction of what a planar laser drew is the vertical: the wall's normal
// must not count as an extent of it.
TEST(SurfaceLikelihood, LinesHaveAMiddle) {
    Mixture<3> wall;
    Gaussian<3> line;
    line.support = 10;
    line.covariance.diagonal() << 1.4 * 1.4, 0.05 * 0.05, 0.008 * 0.008;
    wall.pushBack(line);
    const SurfaceLikelihood likelihood(wall, 0.02, 0.05);
    for (const double off : {0.0, 0.03, 0.06, 0.1}) {
        const double variance = 0.05 * 0.05 + 0.02 * 0.02;
        EXPECT_NEAR(likelihood(0.3F, float(off), 0),
                    std::log(probabilityAt(off * off / variance, 0.05)), 1e-3);
        EXPECT_NEAR(likelihood(2.F, float(off), 0), likelihood(0.F, float(off), 0), 1e-3);
    }
}

TEST(SurfaceLikelihood, UpdatedIsTheSameAsMadeAnew) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    Mixture<3> mixture = tiltedPatches(60, 3);
    SurfaceLikelihood followed(mixture, 0.1, 0.1);
    for (int step = 0; step < 40; ++step) {
        if (step % 3 == 0) mixture.removeSwap(random() % mixture.size());
        if (step % 4 == 0) mixture.append(tiltedPatches(2, unsigned(100 + step)));
        if (step % 10 == 9) mixture = tiltedPatches(30 + step, unsigned(step));
        mixture.mean[step % 3][random() % mixture.size()] += 0.1F;
        mixture.covariance[0][random() % mixture.size()] *= 1.5F;
        followed.update(mixture);
        const SurfaceLikelihood fresh(mixture, 0.1, 0.1);
        for (int i = 0; i < 300; ++i) {
            const float x = normal(random), y = normal(random), z = normal(random);
            ASSERT_EQ(followed.probability(x, y, z), fresh.probability(x, y, z)) << step;
        }
    }
    followed.update({});
    EXPECT_EQ(followed.probability(0, 0, 0), 0.1);
}

TEST(SurfaceLikelihood, DoesNotDependOnSupportOrSizeOfTheMap) {
    const Mixture<3> mixture = wallAndPost();
    Mixture<3> larger = mixture;
    for (float& support : larger.support) support *= 50;
    for (int i = 0; i < 500; ++i) {
        Gaussian<3> far = mixture[1];
        far.mean << 100.0 + i, 0, 0;
        larger.pushBack(far);
    }
    const SurfaceLikelihood a(mixture, 0.1, 0.05), b(larger, 0.1, 0.05);
    for (float x = -1; x < 2; x += 0.1F) EXPECT_EQ(a(x, 0.2F, 0.F), b(x, 0.2F, 0.F));
}

TEST(SurfaceLikelihood, IsFiniteEverywhere) {
    const SurfaceLikelihood likelihood(wallAndPost(), 0.1, 0.05);
    const SurfaceLikelihood empty(Mixture<3>(), 0.1, 0.05);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float v : {0.F, 1e6F, -3e38F, nan, std::numeric_limits<float>::infinity()}) {
        for (const SurfaceLikelihood* l : {&likelihood, &empty}) {
            EXPECT_GE((*l)(v, v, v), std::log(0.05) - 1e-12);
            EXPECT_LE((*l)(v, v, v), 0.0);
        }
    }
    EXPECT_NEAR(empty(0, 0, 0), std::log(0.05), 1e-12);
}

TEST(SurfaceLikelihood, RefusesBadParameters) {
    const Mixture<3> mixture = wallAndPost();
    EXPECT_THROW(SurfaceLikelihood(mixture, -0.1, 0.05), std::invalid_argument);
    EXPECT_THROW(SurfaceLikelihood(mixture, 0.1, 0.0), std::invalid_argument);
    EXPECT_THROW(SurfaceLikelihood(mixture, 0.1, 1.0), std::invalid_argument);
    EXPECT_THROW(SurfaceLikelihood(mixture, std::nan(""), 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
