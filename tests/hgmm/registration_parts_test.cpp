#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "patches.h"
#include "registration/registration_newton.h"
#include "registration/registration_search.h"

namespace hgmm {
namespace {

using namespace testing;

ComponentPair pairAt(const Vector6d& step, const ComponentPair& pair) {
    const Eigen::Matrix3d R = rotationOf(step.head<3>());
    ComponentPair moved = pair;
    moved.arm = R * pair.arm;
    moved.covariance = R * pair.covariance * R.transpose();
    moved.between = pair.between + moved.arm - pair.arm + step.tail<3>();
    return moved;
}

TEST(RegistrationParts, DerivativesAreThoseOfTheCost) {
    std::mt19937_64 random(1);
    for (int trial = 0; trial < 30; ++trial) {
        ComponentPair pair;
        pair.arm = 3 * unitUniform(random) * direction(random);
        pair.between = unitUniform(random) * direction(random);
        pair.covariance = patch(Eigen::Vector3d::Zero(), direction(random), 1.0).covariance;
        pair.widened = patch(Eigen::Vector3d::Zero(), direction(random), 0.5).covariance +
                       0.1 * Eigen::Matrix3d::Identity();
        CostSums sums;
        const Vector6d gradient = addPair(pair, sums);
        EXPECT_NEAR(sums.cost, pairCost(pair), 1e-13);
        EXPECT_EQ((gradient - sums.gradient).norm(), 0.0);
        const double h = 1e-4;
        const auto at = [&](int a, double da, int b, double db) {
            Vector6d step = Vector6d::Zero();
            step[a] += da;
            step[b] += db;
            return pairCost(pairAt(step, pair));
        };
        const double scale = sums.gaussNewton.norm();
        for (int a = 0; a < 6; ++a) {
            EXPECT_NEAR(sums.gradient[a], (at(a, h, a, 0) - at(a, -h, a, 0)) / (2 * h),
                        1e-6 * scale);
            for (int b = 0; b < 6; ++b)
                EXPECT_NEAR(sums.hessian(a, b),
                            (at(a, h, b, h) - at(a, h, b, -h) - at(a, -h, b, h) +
                             at(a, -h, b, -h)) /
                                (4 * h * h),
                            1e-5 * scale)
                    << a << ", " << b;
        }
        Vector6d any;
        for (double& v : any) v = normal(random);
        EXPECT_GE(any.dot(sums.gaussNewton * any), 0.0);
    }
}

TEST(RegistrationParts, FindsTheNearestComponents) {
    const Mixture<3> room = roomOfPatches(3);
    const Shapes shapes(room);
    for (const double width_m : {0.03, 0.4}) {
        TargetLayers layers;
        layers.push(shapes, width_m);
        const RegistrationSource source(seenFrom(somePose(), roomOfPatches(4)));
        Pose T = somePose();
        T.t += T.R * source.centre;
        const auto found = layers.associate(source, {width_m, 0.0}, T);
        for (std::size_t i = 0; i < source.size(); ++i) {
            std::vector<std::pair<double, std::uint32_t>> all;
            for (std::uint32_t j = 0; j < room.size(); ++j) {
                Eigen::Matrix3d S = room[j].covariance;
                S.diagonal().array() += width_m * width_m;
                const Eigen::Vector3d mu = T.R * source.mean[i] + T.t - room[j].mean;
                all.emplace_back(mu.dot(S.llt().solve(mu)), j);
            }
            std::sort(all.begin(), all.end());
            for (std::size_t k = 0; k < Neighbours::kMost; ++k) {
                if (std::abs(all[k].first - 9.0) < 1e-2) continue;  // at the limit
                const std::uint32_t j = found[i].target[k];
                if (all[k].first > 9.0) {
                    EXPECT_EQ(j, Neighbours::kNobody);
                    continue;
                }
                ASSERT_NE(j, Neighbours::kNobody);
                const auto same = std::find_if(
                    all.begin(), all.end(), [j](const auto& d) { return d.second == j; });
                EXPECT_NEAR(same->first, all[k].first, 1e-2 * (1 + all[k].first));
            }
        }
    }
}

TEST(RegistrationParts, NoStepRaisesTheCost) {
    std::mt19937_64 random(5);
    const Mixture<3> room = roomOfPatches(3);
    const RegistrationSource source(seenFrom(somePose(), roomOfPatches(4)));
    for (const double width_m : {0.03, 0.2, 0.5}) {
        TargetLayers layers;
        layers.push(Shapes(room), width_m);
        for (int trial = 0; trial < 10; ++trial) {
            Pose T = somePose();
            T.t += T.R * source.centre;
            T = displaced(T, 2 * width_m, 0.3 * width_m, random);
            const auto neighbours = layers.associate(source, {width_m, 0.0}, T);
            const double before = layers.cost(source, neighbours, T);
            runStage(layers, {width_m, 0.0}, source, {}, T, 1);
            EXPECT_LE(layers.cost(source, neighbours, T), before);
        }
    }
}

TEST(RegistrationParts, PriorIsOfTheSourcesFrame) {
    std::mt19937_64 random(6);
    PosePrior prior;
    prior.T_target_source_guess = somePose();
    prior.centre = {4, -2, 1};
    prior.deviation = {0.5, 0.3};
    prior.weight = 7;
    const Pose turned = displaced(somePose(), 0.0, 0.3, random);
    const Pose shifted = displaced(somePose(), 0.5, 0.0, random);
    const auto ofCentre = [&](Pose T) {
        T.t += T.R * prior.centre;
        return T;
    };
    EXPECT_NEAR(prior.cost(ofCentre(somePose())), 0.0, 1e-12);
    EXPECT_NEAR(prior.cost(ofCentre(turned)), 3.5, 1e-9);  // one deviation
    EXPECT_NEAR(prior.cost(ofCentre(shifted)), 3.5, 1e-9);

    const Pose T = ofCentre(displaced(somePose(), 0.4, 0.02, random));
    CostSums sums;
    prior.addTo(sums, T);
    EXPECT_DOUBLE_EQ(sums.cost, prior.cost(T));
    constexpr double h = 1e-6;
    for (int a = 0; a < 6; ++a) {
        const auto at = [&](double d) {
            Vector6d step = Vector6d::Zero();
            step[a] = d;
            return prior.cost({rotationOf(step.head<3>()) * T.R, T.t + step.tail<3>()});
        };
        // Gauss-Newton's: of the first order in the rotation.
        EXPECT_NEAR(sums.gradient[a], (at(h) - at(-h)) / (2 * h), 0.02 * 7 / 0.3);
    }
}

TEST(RegistrationParts, ThinnedSourcesHalve) {
    std::mt19937_64 random(7);
    Mixture<3> mixture;
    tile({5, 1, 2}, {4, 0, 0}, {0, 4, 0}, 0.2, random, mixture);
    tile({5, 1, 2}, {0.4, 0, 0}, {0, 0, 0.4}, 0.02, random, mixture);  // crowded
    const RegistrationSource whole(mixture);
    const auto sources = thinnedSources(whole);
    ASSERT_GE(sources.size(), 3U);
    EXPECT_EQ(sources.back().size(), whole.size());
    EXPECT_LE(sources.front().size(), 400U);
    EXPECT_GE(sources.front().size(), 100U);
    for (std::size_t s = 0; s + 1 < sources.size(); ++s) {
        EXPECT_LT(sources[s].size(), sources[s + 1].size());
        EXPECT_GT(2.5 * double(sources[s].size()), 0.5 * double(sources[s + 1].size()));
        EXPECT_EQ(sources[s].centre, whole.centre);
        EXPECT_EQ(sources[s].gyrationRadius_m, whole.gyrationRadius_m);
    }
    // What is crowded does not stay so.
    const auto crowded = [](const RegistrationSource& source) {
        return double(std::count_if(
                   source.mean.begin(), source.mean.end(),
                   [&](const Eigen::Vector3d& m) {
                       return (m + source.centre - Eigen::Vector3d(5, 1, 2)).norm() < 0.6;
                   })) /
               double(source.size());
    };
    EXPECT_GT(crowded(whole), 0.4);
    EXPECT_LT(crowded(sources.front()), 0.15);
}

TEST(RegistrationParts, LatticeCoversTheBall) {
    RegistrationParams params;
    const auto nodes = rotationLattice(params);
    std::mt19937_64 random(8);
    for (int trial = 0; trial < 100; ++trial) {
        const Eigen::Vector3d w =
            params.coarseAngle_rad * 0.8 * unitUniform(random) * direction(random);
        double nearest = 1e9;
        for (const Eigen::Vector3d& node : nodes)
            nearest = std::min(nearest, (node - w).norm());
        EXPECT_LE(nearest, params.coarseAngle_rad / 3);
    }
    for (const Eigen::Vector3d& node : nodes)
        EXPECT_LE(node.norm(), params.coarseAngle_rad + 1e-12);
}

}  // namespace
}  // namespace hgmm
