#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "hgmm/em.h"
#include "planted_mixture.h"
#include "scan/cells.h"

namespace hgmm::test {
namespace {

Eigen::Vector3d onSphere(std::mt19937_64& engine, const Eigen::Vector3d& centre,
                         double radius) {
    const Eigen::Vector3d direction(normal(engine), normal(engine), normal(engine));
    return centre + radius * direction.normalized();
}

Eigen::Vector3d onBox(std::mt19937_64& engine, const Eigen::Vector3d& low,
                      const Eigen::Vector3d& size) {
    Eigen::Vector3d p;
    for (int a = 0; a < 3; ++a) p[a] = low[a] + size[a] * uniform(engine, 0, 1);
    const auto side = static_cast<int>(engine() % 6);
    p[side / 2] = low[side / 2] + (side % 2) * size[side / 2];
    return p;
}

/// Points on the surfaces of a furnished room, 5 mm noise, as samples.
Mixture<3> furnishedRoom(std::size_t points, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Mixture<3> samples;
    for (std::size_t i = 0; i < points; ++i) {
        Eigen::Vector3d p;
        switch (engine() % 8) {
            case 0:
                p = onSphere(engine, {1, 1, 0.4}, 0.4);
                break;
            case 1:
                p = onSphere(engine, {-1.2, 0.5, 1.5}, 0.25);
                break;
            case 2:
                p = onBox(engine, {-1.8, -1.2, 0}, {0.6, 0.8, 0.9});
                break;
            case 3:
                p = onBox(engine, {0.8, -1.5, 0}, {1.0, 0.4, 1.8});
                break;
            default:
                p = onBox(engine, {-2, -1.5, 0}, {4, 3, 2.5});
        }
        Gaussian<3> g;
        g.support = 1;
        for (int a = 0; a < 3; ++a) g.mean[a] = p[a] + 0.005 * normal(engine);
        g.covariance = 0.005 * 0.005 * Gaussian<3>::Matrix::Identity();
        samples.pushBack(g);
    }
    return samples;
}

/// Mean expected log-likelihood of samples [nat/point].
double scoreOf(const Mixture<3>& mixture, const Mixture<3>& samples) {
    EmParams none;
    none.maxIterations = 0;
    return fitDense(samples, mixture, none).logLikelihood[0];
}

TEST(Em, SparseIsAsGoodAsDenseOnHeldOutPoints) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Mixture<3> training = furnishedRoom(6000, seed);
        const Mixture<3> heldOut = furnishedRoom(3000, seed + 100);
        const InitialMixture guess =
            initialiseFromCells(training, Eigen::Vector3d(0, 0, 1.2), CellParams());
        EmParams params;
        params.minImprovement = 0;
        const auto sparse =
            fitSparse(training, guess.mixture, guess.neighbourhoods, params);
        const auto dense = fitDense(training, guess.mixture, params);
        ASSERT_EQ(sparse.mixture.size(), dense.mixture.size());
        const double start = scoreOf(guess.mixture, heldOut);
        const double withSparse = scoreOf(sparse.mixture, heldOut);
        const double withDense = scoreOf(dense.mixture, heldOut);
        std::cout << dense.mixture.size() << " components, "
                  << double(guess.neighbourhoods.component.size()) / training.size()
                  << " neighbours a sample, held-out log-likelihood " << start
                  << " from cells, " << withSparse << " sparse, " << withDense
                  << " dense\n";
        RecordProperty("dense_minus_sparse_nat_" + std::to_string(seed),
                       std::to_string(withDense - withSparse));
        EXPECT_GT(withSparse, start);
        EXPECT_NEAR(withSparse, withDense, 0.02);
    }
}

}  // namespace
}  // namespace hgmm::test
