#include "hgmm/registration.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

#include "patches.h"
#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;

TEST(Registration, ReturnsFromHalfAMetreAndTenDegrees) {
    std::mt19937_64 random(2);
    const Mixture<3> target = roomOfPatches(3);
    const Mixture<3> source = seenFrom(somePose(), roomOfPatches(4));
    const RegistrationTarget prepared({&target});
    for (int trial = 0; trial < 20; ++trial) {
        const Pose guess = displaced(somePose(), 0.5, 10 * kDegree, random);
        const Registration found = prepared.align(source, guess);
        const Vector6d error = errorOf(found.T_target_source, somePose());
        EXPECT_TRUE(found.converged);
        EXPECT_GT(found.overlap, 0.95);
        EXPECT_LT(error.tail<3>().norm(), 0.01);
        EXPECT_LT(error.head<3>().norm(), 0.3 * kDegree);
        EXPECT_TRUE(found.T_target_source.R.isUnitary(1e-9));
    }
}

TEST(Registration, ReturnsWhereAllIsFarFromTheSensor) {
    const Pose T_target_sensor =
        somePose() * Pose{Eigen::Matrix3d::Identity(), {-15, 4, 1}};
    const Mixture<3> target = roomOfPatches(3);
    const Mixture<3> source = seenFrom(T_target_sensor, roomOfPatches(4));
    const RegistrationTarget prepared({&target});
    std::mt19937_64 random(12);
    for (int trial = 0; trial < 20; ++trial) {
        const Registration found =
            prepared.align(source, displaced(T_target_sensor, 0.5, 10 * kDegree, random));
        const Vector6d error = errorOf(found.T_target_source, T_target_sensor);
        EXPECT_LT(error.tail<3>().norm(), 0.1);
        EXPECT_LT(error.head<3>().norm(), 0.3 * kDegree);
    }
}

TEST(Registration, MoreOverlapDoesNotPullFarFromTheGuess) {
    // A corridor whose end the source sees and the target does not: sliding back by its
    // length, all would overlap, but for a niche that says where it is.
    const auto corridor = [](double from_m, double to_m, std::uint64_t seed) {
        std::mt19937_64 random(seed);
        const double middle_m = (from_m + to_m) / 2;
        const Eigen::Vector3d x((to_m - from_m) / 2, 0, 0), z(0, 0, 1.2);
        Mixture<3> mixture;
        tile({middle_m, 0, 0}, x, {0, 1, 0}, 0.4, random, mixture);
        tile({middle_m, 1, 1.2}, x, z, 0.4, random, mixture);
        tile({middle_m, -1, 1.2}, x, z, 0.4, random, mixture);
        tile({3, 1.4, 1.2}, {0, 0.4, 0}, z, 0.2, random, mixture);
        return mixture;
    };
    const Mixture<3> target = corridor(-6, 4, 1);
    const Mixture<3> source = seenFrom(somePose(), corridor(0, 10, 2));
    const RegistrationTarget prepared({&target});
    std::mt19937_64 random(13);
    for (int trial = 0; trial < 10; ++trial) {
        const Registration found =
            prepared.align(source, displaced(somePose(), 0.5, 5 * kDegree, random));
        const Vector6d error = errorOf(found.T_target_source, somePose());
        EXPECT_LT(error.tail<3>().norm(), 0.2);
        EXPECT_LT(error.head<3>().norm(), 0.5 * kDegree);
    }
}

TEST(Registration, AlignsAScanWithAMap) {
    testing::RoomScanner scanner;
    const Map map = testing::mapOf(scanner, 4);
    std::vector<const Mixture<3>*> levels;
    for (std::size_t level = map.levelCount(); level-- > 0;)
        levels.push_back(&map.mixture(level));
    const RegistrationTarget target(levels);
    std::mt19937_64 random(4);
    for (int trial = 0; trial < 10; ++trial) {
        const Scan scan = scanner.scan(testing::walk(20 + trial, 0.8), 50);
        Pose truth = scan.T_map_sensor;
        truth.t -= map.origin();
        const Registration found =
            target.align(filterScan(scan, map.params().filter),
                         displaced(truth, 0.5, 10 * kDegree, random));
        const Vector6d error = errorOf(found.T_target_source, truth);
        EXPECT_TRUE(found.converged);
        EXPECT_LT(error.tail<3>().norm(), 0.03);
        EXPECT_LT(error.head<3>().norm(), 0.5 * kDegree);
    }
}

TEST(Registration, WhatHasNoCounterpartDoesNotPull) {
    const Mixture<3> target = roomOfPatches(3);
    Mixture<3> more = roomOfPatches(4);
    std::mt19937_64 random(6);
    tile({0, -6, 1.2}, {2, 0, 0.5}, {0, 0, 1.2}, 0.4, random, more);  // beyond the wall
    tile({12, 0, 0}, {4, 0, 0}, {0, 3, 0.5}, 0.4, random, more);
    const Registration found =
        registerMixtures({&target}, seenFrom(somePose(), more),
                         displaced(somePose(), 0.3, 5 * kDegree, random));
    EXPECT_TRUE(found.converged);
    EXPECT_LT(found.overlap, 0.75);
    EXPECT_GT(found.overlap, 0.5);
    const Vector6d error = errorOf(found.T_target_source, somePose());
    EXPECT_LT(error.tail<3>().norm(), 0.015);
    EXPECT_LT(error.head<3>().norm(), 0.3 * kDegree);
}

TEST(Registration, DoesNotDependOnTheSourcesFrame) {  // of which the guess is as good
    const Mixture<3> target = roomOfPatches(3);
    const Mixture<3> source = seenFrom(somePose(), roomOfPatches(4));
    const Pose T_source_other{rotationOf({0.4, 0.1, -0.3}), {1.5, -0.7, 0.3}};
    std::mt19937_64 random(8);
    const Pose guess = displaced(somePose(), 0.3, 5 * kDegree, random);
    const Registration a = registerMixtures({&target}, source, guess);
    const Registration b = registerMixtures({&target}, seenFrom(T_source_other, source),
                                            guess * T_source_other);
    const Pose expected = a.T_target_source * T_source_other;
    EXPECT_LT(errorOf(b.T_target_source, expected).norm(), 1e-3);
    Matrix6d J = Matrix6d::Identity();  // v' = v + w x (R t)
    J.bottomLeftCorner<3, 3>() = -crossMatrix(a.T_target_source.R * T_source_other.t);
    const Matrix6d transported = J * Matrix6d(a.covariance) * J.transpose();
    EXPECT_LT((transported - Matrix6d(b.covariance)).norm(), 0.05 * transported.norm());
}

TEST(Registration, DoesNotDependOnThreads) {
    const Mixture<3> target = roomOfPatches(3);
    const Mixture<3> source = seenFrom(somePose(), roomOfPatches(4));
    std::mt19937_64 random(9);
    const Pose guess = displaced(somePose(), 0.5, 10 * kDegree, random);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const Registration one = registerMixtures({&target}, source, guess);
    for (const int n : {2, 3, 5}) {
        omp_set_num_threads(n);
        const Registration many = registerMixtures({&target}, source, guess);
        EXPECT_EQ(many.T_target_source.R, one.T_target_source.R);
        EXPECT_EQ(many.T_target_source.t, one.T_target_source.t);
        EXPECT_EQ(Matrix6d(many.covariance), Matrix6d(one.covariance));
        EXPECT_EQ(many.cost, one.cost);
    }
    omp_set_num_threads(threads);
}

TEST(Registration, WhatIsFarDoesNotMatter) {
    const Mixture<3> target = roomOfPatches(3);
    Mixture<3> large = target;
    for (int k = 1; k < 20; ++k) {
        Pose away;
        away.t = {60.0 * k, 0, 0};
        large.append(transformed(target, away));
    }
    const Mixture<3> source = seenFrom(somePose(), roomOfPatches(4));
    std::mt19937_64 random(10);
    const Pose guess = displaced(somePose(), 0.5, 10 * kDegree, random);
    const Registration a = registerMixtures({&target}, source, guess);
    const Registration b = RegistrationTarget({&large}).align(source, guess);
    EXPECT_EQ(a.T_target_source.t, b.T_target_source.t);
    EXPECT_EQ(a.T_target_source.R, b.T_target_source.R);
    EXPECT_EQ(a.cost, b.cost);
}

TEST(Registration, GivesTheGuessBackWhereNothingIsFound) {
    const Mixture<3> room = roomOfPatches(3), empty;
    Pose far = somePose();
    far.t.x() += 500;
    const auto expectUnknown = [](const Registration& found, const Pose& guess) {
        EXPECT_FALSE(found.converged);
        EXPECT_EQ(found.T_target_source.t, guess.t);
        EXPECT_EQ(found.T_target_source.R, guess.R);
        EXPECT_EQ(found.overlap, 0.0);
        EXPECT_EQ(found.cost, 0.0);
        EXPECT_EQ(found.covariance(3, 3), kUnobservable_m * kUnobservable_m);
        EXPECT_EQ(found.covariance(0, 0), kUnobservable_rad * kUnobservable_rad);
    };
    expectUnknown(registerMixtures({&room}, room, far), far);
    expectUnknown(registerMixtures({&empty}, room, far), far);
    expectUnknown(registerMixtures({&room}, empty, far), far);
    expectUnknown(registerMixtures({&empty}, empty, far), far);
    expectUnknown(RegistrationTarget({&empty}).align(room, far), far);
}

TEST(Registration, LittleOverlapIsNotConverged) {
    const Mixture<3> room = roomOfPatches(3);
    Mixture<3> source = roomOfPatches(3);
    Pose away;
    away.t = {100, 0, 0};
    for (int k = 0; k < 15; ++k) source.append(transformed(room, away));
    EXPECT_FALSE(registerMixtures({&room}, source, Pose()).converged);
}

TEST(Registration, LeavesOutComponentsThatAreNotFinite) {
    const Mixture<3> target = roomOfPatches(3);
    const Mixture<3> source = seenFrom(somePose(), roomOfPatches(4));
    std::mt19937_64 random(11);
    const Pose guess = displaced(somePose(), 0.2, 5 * kDegree, random);
    const auto spoiled = [](Mixture<3> mixture) {
        Gaussian<3> g = mixture[0];
        g.mean[1] = std::numeric_limits<double>::quiet_NaN();
        mixture.pushBack(g);
        g = mixture[0];
        g.covariance(0, 0) = std::numeric_limits<double>::infinity();
        mixture.pushBack(g);
        return mixture;
    };
    const Mixture<3> spoiledTarget = spoiled(target);
    const Registration clean = RegistrationTarget({&target}).align(source, guess);
    const Registration found =
        RegistrationTarget({&spoiledTarget}).align(spoiled(source), guess);
    EXPECT_EQ(found.T_target_source.t, clean.T_target_source.t);
    EXPECT_EQ(found.overlap, clean.overlap);
    EXPECT_EQ(registerMixtures({&spoiledTarget}, spoiled(source), guess).overlap,
              clean.overlap);
}

TEST(Registration, SingleAndDegenerateComponentsGiveFiniteResults) {
    Gaussian<3> point;
    point.support = 1;
    Mixture<3> one;
    one.pushBack(point);  // no extent at all
    Pose guess;
    guess.t = {0.1, 0, 0};
    const Registration found = registerMixtures({&one}, one, guess);
    EXPECT_TRUE(found.T_target_source.t.allFinite());
    EXPECT_LT(found.T_target_source.t.norm(), 0.01);
    const Matrix6d covariance = found.covariance;
    EXPECT_TRUE(covariance.allFinite());
    EXPECT_EQ(covariance.llt().info(), Eigen::Success);
}

TEST(Registration, RefusesBadInput) {
    const Mixture<3> room = roomOfPatches(3);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Pose bad;
    bad.t.x() = nan;
    EXPECT_THROW(registerMixtures({&room}, room, bad), std::invalid_argument);
    EXPECT_THROW(RegistrationTarget({&room}).align(room, bad), std::invalid_argument);
    bad = Pose();
    bad.R(0, 0) = nan;
    EXPECT_THROW(registerMixtures({&room}, room, bad), std::invalid_argument);
    bad.R = 1.1 * Eigen::Matrix3d::Identity();
    EXPECT_THROW(registerMixtures({&room}, room, bad), std::invalid_argument);
    bad.R = -Eigen::Matrix3d::Identity();
    EXPECT_THROW(registerMixtures({&room}, room, bad), std::invalid_argument);
    EXPECT_THROW(registerMixtures({}, room, Pose()), std::invalid_argument);
    EXPECT_THROW(registerMixtures({nullptr}, room, Pose()), std::invalid_argument);
    EXPECT_THROW(RegistrationTarget({}), std::invalid_argument);
}

TEST(Registration, RefusesBadParameters) {
    const auto refused = [](auto change) {
        RegistrationParams params;
        change(params);
        EXPECT_THROW(params.validate(), std::invalid_argument);
        const Mixture<3> empty;
        EXPECT_THROW(RegistrationTarget({&empty}, params), std::invalid_argument);
    };
    EXPECT_NO_THROW(RegistrationParams().validate());
    refused([](RegistrationParams& p) { p.fineWidth_m = 0; });
    refused([](RegistrationParams& p) { p.coarseWidth_m = p.fineWidth_m / 2; });
    refused([](RegistrationParams& p) { p.coarseWidth_m = std::nan(""); });
    refused([](RegistrationParams& p) { p.fineAngle_rad = 0; });
    refused([](RegistrationParams& p) { p.coarseAngle_rad = p.fineAngle_rad / 2; });
    refused([](RegistrationParams& p) { p.maxStageIterations = 0; });
    refused([](RegistrationParams& p) { p.minOverlap = 1.5; });
}

}  // namespace
}  // namespace hgmm
