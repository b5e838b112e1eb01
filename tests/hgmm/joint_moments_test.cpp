#include "hgmm/joint_moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "hgmm/params.h"
#include "hgmm/regression.h"
#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::normal;
using test::randomCovariance;
using test::uniform;

/// Moments of points over (X, W) drawn one by one.
class Moments {
 public:
    void add(const Eigen::Vector3d& x, double w) {
        const Eigen::Vector4d p(x.x(), x.y(), x.z(), w);
        ++count_;
        sum_ += p;
        outer_ += p * p.transpose();
    }
    void expectNear(const Gaussian<4>& g, double tolerance) const {
        const Eigen::Vector4d mean = sum_ / count_;
        const Eigen::Matrix4d covariance = outer_ / count_ - mean * mean.transpose();
        EXPECT_LT((mean - g.mean).cwiseAbs().maxCoeff(), tolerance);
        EXPECT_LT((covariance - g.covariance).cwiseAbs().maxCoeff(), tolerance);
    }

 private:
    double count_ = 0;
    Eigen::Vector4d sum_ = Eigen::Vector4d::Zero();
    Eigen::Matrix4d outer_ = Eigen::Matrix4d::Zero();
};

Eigen::Vector3d draw(const Gaussian<3>& g, std::mt19937_64& engine) {
    const Eigen::Matrix3d covariance = g.covariance;
    return g.mean + covariance.llt().matrixL() *
                        Eigen::Vector3d(normal(engine), normal(engine), normal(engine));
}

Gaussian<3> surfaceAt(const Eigen::Vector3d& mean, double size, std::mt19937_64& engine) {
    Gaussian<3> g;
    g.support = 30;
    g.mean = mean;
    g.covariance = size * size * randomCovariance<3>(engine, 20);
    return g;
}

TEST(Band, AugmentedHasTheMomentsOfHitsAndFreePoints) {
    std::mt19937_64 engine(1);
    for (const double freeShare : {0.2, 0.5, 0.9}) {
        const Gaussian<3> surface = surfaceAt({1, -2, 0.5}, 0.4, engine);
        const ViewDirection view = viewFrom({3, 1, 2}, surface.mean);
        const double width = 0.8;
        Moments moments;
        for (int i = 0; i < 200000; ++i) {
            const double w =
                uniform(engine, 0, 1) < freeShare ? uniform(engine, 0, width) : 0;
            moments.add(draw(surface, engine) + w * view.direction, w);
        }
        const Gaussian<4> g = augmented(surface, view, width, freeShare);
        moments.expectNear(g, 0.006);
        EXPECT_NEAR(g.support * (1 - freeShare), surface.support, 1e-9);
    }
}

TEST(Band, ConditioningOnZeroDistanceGivesTheSurfaceBack) {
    std::mt19937_64 engine(2);
    for (int i = 0; i < 100; ++i) {
        const Gaussian<3> surface = surfaceAt({1, -2, 0.5}, 0.3, engine);
        const ViewDirection view =
            viewFrom(Eigen::Vector3d(normal(engine), normal(engine), 4), surface.mean);
        Mixture<4> joint;
        joint.pushBack(augmented(surface, view, 0.5, 0.5));
        const Gaussian<3> back = spatialModel(joint)[0];
        EXPECT_LT((back.mean - surface.mean).norm(), 1e-5);
        EXPECT_LT((back.covariance - surface.covariance).norm(),
                  1e-4 * surface.covariance.norm());
    }
}

TEST(Band, FreeSlabHasTheMomentsOfRays) {
    std::mt19937_64 engine(3);
    const Gaussian<3> hits = surfaceAt({6, 1, 0}, 0.3, engine);
    const Eigen::Vector3d sensor(0, 0, 1);
    const double range = (sensor - hits.mean).norm();
    for (const auto& [from, to] : {std::pair{0.5, 1.0}, {0.0, range}, {3.0, 5.5}}) {
        Moments rays;
        for (int i = 0; i < 200000; ++i) {
            const Eigen::Vector3d hit = draw(hits, engine);
            const double w = uniform(engine, from, to);
            rays.add(hit + w / range * (sensor - hit), w);
        }
        Gaussian<4> g = raySegmentMoments(hits, sensor, from, to);
        EXPECT_EQ(g.support, hits.support);
        g.covariance.diagonal().array() -= 1e-4;  // thickness of 1 cm
        rays.expectNear(g, 0.01 + 0.004 * (to - from) * (to - from));
    }
}

TEST(Band, FreeSlabIsNarrowAtTheSensorAndWideAtTheSurface) {
    Gaussian<3> hits;
    hits.support = 1;
    hits.mean << 10, 0, 0;
    hits.covariance = Eigen::Matrix3d::Identity();
    const auto width = [&](double from, double to) {
        return std::sqrt(raySegmentMoments(hits, {0, 0, 0}, from, to).covariance(1, 1));
    };
    EXPECT_NEAR(width(0, 0.02), 1.0, 0.01);
    EXPECT_NEAR(width(4.99, 5.01), 0.5, 0.01);
    EXPECT_NEAR(width(9.99, 10), 0.01, 0.005);
}

TEST(Band, GrowsWithRange) {
    FreeSpaceBandParams band;
    EXPECT_EQ(band.width(0), band.bandBase_m);
    EXPECT_NEAR(band.width(100) - band.width(0), 100 * band.bandPerRange, 1e-12);
    EXPECT_EQ(band.reach(0), band.width(0));  // never less than the width
    EXPECT_EQ(band.reach(100), 100 * band.bandReachPerRange);
    band.freeShare = 0.5;  // as many as hits
    EXPECT_NEAR(band.freePerMetre(7) * band.width(7), 1.0, 1e-12);
    band.freeShare = 0.75;
    EXPECT_NEAR(band.freePerMetre(7) * band.width(7), 3.0, 1e-12);
}

TEST(Band, ParametersOutOfRangeAreNamed) {
    FreeSpaceBandParams band;
    band.validate();
    band.freeShare = 1.0;
    EXPECT_THROW(band.validate(), std::invalid_argument);
    band = {};
    band.bandBase_m = std::nan("");
    EXPECT_THROW(band.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
