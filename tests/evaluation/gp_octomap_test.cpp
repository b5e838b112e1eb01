#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <vector>

#include "hgmm/evaluation/gp_octomap_baseline.h"
#include "hgmm/evaluation/split.h"
#include "voxel_centres.h"

using namespace hgmm::evaluation;

namespace {

using Eigen::Vector3d;

struct Training {
    std::vector<Vector3d> points;
    std::vector<double> labels;
};

/// Nothing saturates, merges or is thinned; a block spans 0.4 m.
GpOctomapParams plainParams() {
    GpOctomapParams p = GpOctomapParams::atResolution(0.1);
    p.noise = 0.3;
    p.minVariance = 1e-9;
    p.gain = 1e-6;
    p.mergeProbability = 0.999;
    p.sampleSpacing_m = 0.001;
    p.freeSpacing_m = 0.07;
    return p;
}

/// Rays from `sensor` to n points within a box, all in the map frame.
hgmm::Scan randomScan(const Vector3d& sensor, const Vector3d& low, const Vector3d& high,
                      int n, std::uint64_t seed) {
    auto stream = randomStream(seed, 0, Draw::queries);
    hgmm::Scan scan;
    scan.T_map_sensor.t = sensor;
    for (int i = 0; i < n; ++i) {
        Vector3d p;
        for (int k = 0; k < 3; ++k)
            p[k] = low[k] + (high[k] - low[k]) * nextUniform(stream) - sensor[k];
        scan.pushBack(static_cast<float>(p.x()), static_cast<float>(p.y()),
                      static_cast<float>(p.z()));
    }
    return scan;
}

/// The samples that a scan without thinning gives, hits first.
Training trainingOf(const hgmm::Scan& scan, double freeSpacing_m) {
    Training t;
    std::vector<Vector3d> rays;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        rays.emplace_back(scan.x[i], scan.y[i], scan.z[i]);
        t.points.push_back(scan.T_map_sensor.t + scan.T_map_sensor.R * rays.back());
        t.labels.push_back(1.0);
    }
    for (const Vector3d& ray : rays)
        for (double r = ray.norm() - freeSpacing_m; r >= 0.0; r -= freeSpacing_m) {
            t.points.push_back(scan.T_map_sensor.t +
                               scan.T_map_sensor.R * ray.normalized() * r);
            t.labels.push_back(-1.0);
        }
    return t;
}

/// Those of some training data that a predicate accepts.
Training select(const Training& all, const std::function<bool(const Vector3d&)>& accepts) {
    Training t;
    for (std::size_t i = 0; i < all.points.size(); ++i)
        if (accepts(all.points[i])) {
            t.points.push_back(all.points[i]);
            t.labels.push_back(all.labels[i]);
        }
    return t;
}

double matern32(const Vector3d& a, const Vector3d& b, const GpOctomapParams& p) {
    const double s = std::sqrt(3.0) * (a - b).norm() / p.length_m;
    return p.sigmaF * p.sigmaF * (1 + s) * std::exp(-s);
}

/// Rasmussen and Williams, eqs. 2.25 and 2.26, with the inverse written out.
GpBelief denseGp(const Training& t, const Vector3d& x, const GpOctomapParams& p) {
    const auto n = static_cast<Eigen::Index>(t.points.size());
    Eigen::MatrixXd K(n, n);
    Eigen::VectorXd k(n), y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto u = static_cast<std::size_t>(i);
        for (Eigen::Index j = 0; j < n; ++j)
            K(i, j) = matern32(t.points[u], t.points[static_cast<std::size_t>(j)], p) +
                      (i == j ? p.noise * p.noise : 0.0);
        k[i] = matern32(t.points[u], x, p);
        y[i] = t.labels[u];
    }
    const Eigen::MatrixXd inverse = K.inverse();
    return {k.dot(inverse * y), p.sigmaF * p.sigmaF - k.dot(inverse * k)};
}

/// Bayesian Committee Machine (Tresp 2000).
GpBelief committee(const std::vector<GpBelief>& members, const GpOctomapParams& p) {
    const double prior = 1.0 / (p.sigmaF * p.sigmaF);
    double precision = -(static_cast<double>(members.size()) - 1) * prior, vector = 0.0;
    for (const GpBelief& m : members) {
        precision += 1.0 / m.variance;
        vector += m.mean / m.variance;
    }
    return {vector / precision, 1.0 / precision};
}

void expectBelief(const GpBelief& is, const GpBelief& wanted, const Vector3d& at) {
    EXPECT_NEAR(is.mean, wanted.mean, 2e-5) << at.transpose();
    EXPECT_NEAR(is.variance, wanted.variance, 2e-6) << at.transpose();
}

}  // namespace

TEST(GpOctomap, OneBlockIsTheDenseGaussianProcess) {
    const GpOctomapParams p = plainParams();
    // Block [-0.4, 0) x [0, 0.4) x [0, 0.4).
    const hgmm::Scan scan =
        randomScan({-0.39, 0.03, 0.21}, {-0.3, 0.1, 0.05}, {-0.01, 0.39, 0.39}, 12, 1);
    const Training t = trainingOf(scan, p.freeSpacing_m);
    ASSERT_GT(t.points.size(), 40U);
    GpOctomapBaseline map(p);
    map.insert(scan);
    double lowest = 1.0, highest = -1.0;
    forVoxels({-0.4, 0.0, 0.0}, {0.0, 0.4, 0.4}, [&](const Vector3d& x) {
        const GpBelief wanted = denseGp(t, x, p);
        expectBelief(map.beliefAt(x), wanted, x);
        lowest = std::min(lowest, wanted.mean);
        highest = std::max(highest, wanted.mean);
    });
    EXPECT_LT(lowest, -0.5) << "both labels must matter";
    EXPECT_GT(highest, 0.5);
    // Blocks that share a face are told, those that share an edge are not.
    for (const Vector3d& low :
         {Vector3d(0.0, 0.0, 0.0), Vector3d(-0.4, -0.4, 0.0), Vector3d(-0.4, 0.0, 0.4)})
        forVoxels(low, low + Vector3d::Constant(0.4), [&](const Vector3d& x) {
            expectBelief(map.beliefAt(x), denseGp(t, x, p), x);
        });
    const Vector3d diagonal(0.05, 0.45, 0.05);
    EXPECT_LT(denseGp(t, diagonal, p).variance, 0.24);
    expectBelief(map.beliefAt(diagonal), {0.0, 0.25}, diagonal);
}

TEST(GpOctomap, ScansAreFusedByTheCommittee) {
    const GpOctomapParams p = plainParams();
    const Vector3d low(0.05, 0.05, 0.05), high(0.39, 0.39, 0.39);
    const hgmm::Scan first = randomScan({0.01, 0.2, 0.2}, low, high, 9, 2),
                     second = randomScan({0.2, 0.01, 0.2}, low, high, 7, 3);
    GpOctomapBaseline map(p);
    map.insert(first);
    map.insert(second);
    forVoxels({0, 0, 0}, {0.4, 0.4, 0.4}, [&](const Vector3d& x) {
        const GpBelief a = denseGp(trainingOf(first, p.freeSpacing_m), x, p);
        const GpBelief b = denseGp(trainingOf(second, p.freeSpacing_m), x, p);
        expectBelief(map.beliefAt(x), committee({a, b}, p), x);
    });
}

TEST(GpOctomap, BlocksOfAScanAreFusedByTheCommittee) {
    const GpOctomapParams p = plainParams();
    const hgmm::Scan scan =
        randomScan({0.05, 0.2, 0.2}, {0.5, 0.05, 0.05}, {0.79, 0.39, 0.39}, 8, 4);
    const Training all = trainingOf(scan, p.freeSpacing_m);
    const Training left = select(all, [](const Vector3d& x) { return x.x() < 0.4; });
    const Training right = select(all, [](const Vector3d& x) { return x.x() >= 0.4; });
    ASSERT_GT(left.points.size(), 10U);
    ASSERT_GT(right.points.size(), 10U);
    GpOctomapBaseline map(p);
    map.insert(scan);
    forVoxels({0.0, 0.0, 0.0}, {0.8, 0.4, 0.4}, [&](const Vector3d& x) {
        expectBelief(map.beliefAt(x),
                     committee({denseGp(left, x, p), denseGp(right, x, p)}, p), x);
    });
}

TEST(GpOctomap, CrowdedBlocksAreThinnedEvenly) {
    GpOctomapParams p = plainParams();
    p.maxBlockPoints = 10;
    const hgmm::Scan scan =
        randomScan({0.01, 0.2, 0.2}, {0.05, 0.05, 0.05}, {0.39, 0.39, 0.39}, 12, 5);
    const Training all = trainingOf(scan, p.freeSpacing_m);
    ASSERT_GT(all.points.size(), 25U);
    Training kept;
    for (std::size_t i = 0; i < 10; ++i) {
        kept.points.push_back(all.points[i * all.points.size() / 10]);
        kept.labels.push_back(all.labels[i * all.points.size() / 10]);
    }
    GpOctomapBaseline map(p);
    map.insert(scan);
    forVoxels({0, 0, 0}, {0.4, 0.4, 0.4}, [&](const Vector3d& x) {
        expectBelief(map.beliefAt(x), denseGp(kept, x, p), x);
    });
}

TEST(GpOctomap, PointsOfACellAreReplacedByTheirMean) {
    GpOctomapParams p = plainParams();
    p.sampleSpacing_m = 0.1;
    p.freeSpacing_m = 0.2;  // one free sample a ray
    hgmm::Scan cell, mean;
    cell.T_map_sensor.t = mean.T_map_sensor.t = Vector3d(0.0, 0.05, 0.05);
    cell.pushBack(0.31F, 0.F, 0.01F);
    cell.pushBack(0.33F, 0.04F, 0.F);
    cell.pushBack(0.38F, -0.04F, -0.01F);
    mean.pushBack(0.34F, 0.F, 0.F);
    GpOctomapBaseline ofCell(p), ofMean(p);
    ofCell.insert(cell);
    ofMean.insert(mean);
    forVoxels({0, 0, 0}, {0.4, 0.4, 0.4}, [&](const Vector3d& x) {
        expectBelief(ofCell.beliefAt(x), ofMean.beliefAt(x), x);
        expectBelief(ofCell.beliefAt(x), denseGp(trainingOf(mean, 0.2), x, p), x);
    });
}
