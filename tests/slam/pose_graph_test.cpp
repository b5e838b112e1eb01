#include "hgmm/slam/pose_graph.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <random>
#include <sstream>
#include <stdexcept>

namespace hgmm::slam {
namespace {

Matrix6d isotropic(double sigma_rad, double sigma_m) {
    Matrix6d covariance = Matrix6d::Zero();
    covariance.topLeftCorner<3, 3>().diagonal().setConstant(sigma_rad * sigma_rad);
    covariance.bottomRightCorner<3, 3>().diagonal().setConstant(sigma_m * sigma_m);
    return covariance;
}

/// A ring of nodes in space, true poses known, whose odometry drifts.
struct Ring {
    explicit Ring(int nodes, std::uint64_t seed = 1) {
        for (int k = 0; k < nodes; ++k) {
            const double angle = 2 * M_PI * k / nodes;
            truth.push_back(
                {rotationOf({0.0, 0.0, angle}),
                 {10 * std::cos(angle), 10 * std::sin(angle), std::sin(2 * angle)}});
        }
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        graph.T_world_node.push_back(truth[0]);
        for (std::size_t k = 1; k < truth.size(); ++k) {
            Vector6d error;
            for (int i = 0; i < 6; ++i) error[i] = (i < 3 ? 0.01 : 0.03) * normal(random);
            const Pose measured = displacedBy(truth[k - 1].inverse() * truth[k], error);
            graph.T_world_node.push_back(graph.T_world_node.back() * measured);
            graph.edges.push_back({k - 1, k, {measured, isotropic(0.01, 0.03)}, {}});
        }
    }

    void close(std::size_t from, std::size_t to, const Vector6d& error = Vector6d::Zero()) {
        graph.edges.push_back(
            {from,
             to,
             {displacedBy(truth[from].inverse() * truth[to], error), isotropic(1e-3, 1e-2)},
             PoseEdge::Kind::closure});
    }

    double errorAt(std::size_t node) const {
        return (graph.T_world_node[node].t - truth[node].t).norm();
    }

    std::vector<Pose> truth;
    PoseGraph graph;
};

/// Half the sum of squared errors of a graph, all edges alike.
double costOf(const PoseGraph& graph) {
    double cost = 0;
    for (const PoseEdge& e : graph.edges)
        cost += 0.5 * squaredMahalanobis(errorOf(graph.T_world_node[e.from].inverse() *
                                                     graph.T_world_node[e.to],
                                                 e.T_from_to.T_a_b),
                                         e.T_from_to.covariance);
    return cost;
}

TEST(PoseGraph, AClosureTakesDriftOutOfTheLoop) {
    Ring ring(40);
    const double before = ring.errorAt(39);
    ring.close(0, 39);
    const Optimisation done = optimise(ring.graph);
    EXPECT_EQ(done.nodes, 39U);
    EXPECT_GT(before, 0.3);
    EXPECT_LT(ring.errorAt(39), 0.05);
}

TEST(PoseGraph, TheOptimumIsAMinimum) {
    Ring ring(12);
    ring.close(0, 11);
    ring.close(2, 8);
    OptimisationParams params;
    params.kernelWidth = 1e6;  // least squares
    optimise(ring.graph, 0, params);
    const double lowest = costOf(ring.graph);
    for (std::size_t node = 1; node < 12; ++node)
        for (int axis = 0; axis < 6; ++axis)
            for (const double step : {-1e-3, 1e-3}) {
                PoseGraph other = ring.graph;
                Vector6d error = Vector6d::Zero();
                error[axis] = step;
                other.T_world_node[node] = displacedBy(other.T_world_node[node], error);
                EXPECT_GT(costOf(other), lowest) << node << ' ' << axis;
            }
}

TEST(PoseGraph, AFalseClosureAmongTrueOnesCostsLittle) {
    Ring ring(40);
    ring.close(0, 39);
    ring.close(1, 38);
    ring.close(3, 36);
    optimise(ring.graph);
    const double before = ring.errorAt(20);
    Vector6d wrong;
    wrong << 0, 0, 1.5, 6, -4, 0;
    ring.close(5, 20, wrong);
    optimise(ring.graph, ring.graph.edges.size() - 1);
    EXPECT_LT(ring.errorAt(20), before + 0.1);
}

TEST(PoseGraph, OnlyTheLoopMovesAndWhatFollowsMovesRigidly) {
    Ring ring(40);
    const PoseGraph before = ring.graph;
    ring.close(10, 25);
    const Optimisation done = optimise(ring.graph);
    EXPECT_EQ(done.nodes, 15U);
    for (std::size_t k = 0; k <= 10; ++k)
        EXPECT_LT(errorOf(ring.graph.T_world_node[k], before.T_world_node[k]).norm(),
                  1e-12);
    for (std::size_t k = 26; k < 40; ++k)
        EXPECT_LT(
            errorOf(ring.graph.T_world_node[25].inverse() * ring.graph.T_world_node[k],
                    before.T_world_node[25].inverse() * before.T_world_node[k])
                .norm(),
            1e-9);
    EXPECT_GT((ring.graph.T_world_node[39].t - before.T_world_node[39].t).norm(), 1e-3);
}

TEST(PoseGraph, LoopsThatShareNodesMoveTogether) {
    Ring ring(40);
    ring.close(5, 15);
    optimise(ring.graph);
    ring.close(10, 30);
    EXPECT_EQ(optimise(ring.graph, ring.graph.edges.size() - 1).nodes, 25U);
    ring.close(30, 38);  // shares a node only
    EXPECT_EQ(optimise(ring.graph, ring.graph.edges.size() - 1).nodes, 8U);
}

TEST(PoseGraph, UncertaintyGrowsAlongTheWayAndClosuresAreShortCuts) {
    Ring ring(40);
    std::vector<UncertainPose> seen = poseOfAll(ring.graph, 0);
    for (std::size_t k = 1; k < 40; ++k)
        EXPECT_GT(seen[k].covariance.trace(), seen[k - 1].covariance.trace());
    UncertainPose chain;
    for (std::size_t k = 0; k < 39; ++k) chain = chain * ring.graph.edges[k].T_from_to;
    EXPECT_LT((chain.covariance - seen[39].covariance).norm(), 1e-9);
    ring.close(0, 39);
    seen = poseOfAll(ring.graph, 0);
    EXPECT_LT(seen[39].covariance(3, 3), 1.1e-4);
    EXPECT_LT(seen[37].covariance.trace(), seen[20].covariance.trace());
    const Pose back = poseOfAll(ring.graph, 39)[0].T_a_b;
    EXPECT_LT(errorOf(back.inverse(),
                      ring.graph.T_world_node[0].inverse() * ring.graph.T_world_node[39])
                  .norm(),
              1e-9);
}

TEST(PoseGraph, G2oHoldsPosesAndTheInformationOfItsOwnError) {
    Ring ring(3);
    ring.graph.edges[0].T_from_to.covariance(0, 3) = 1e-4;
    ring.graph.edges[0].T_from_to.covariance(3, 0) = 1e-4;
    std::istringstream lines(g2oText(ring.graph));
    std::string line, word;
    int vertices = 0, edges = 0;
    while (std::getline(lines, line)) {
        std::istringstream in(line);
        in >> word;
        if (word == "VERTEX_SE3:QUAT") ++vertices;
        if (word != "EDGE_SE3:QUAT" || edges++ > 0) continue;
        std::size_t from, to;
        Eigen::Vector3d t;
        Eigen::Quaterniond q;
        in >> from >> to >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
        Eigen::Matrix<double, 6, 6> information;
        for (int row = 0; row < 6; ++row)
            for (int col = row; col < 6; ++col) {
                in >> information(row, col);
                information(col, row) = information(row, col);
            }
        ASSERT_TRUE(in);
        // The squared error as g2o has it, of a pose a little off the measured one.
        const UncertainPose& edge = ring.graph.edges[0].T_from_to;
        Vector6d off;
        off << 1e-4, -2e-4, 3e-4, 2e-3, 1e-3, -1e-3;
        const Pose actual = displacedBy(edge.T_a_b, off);
        const Pose difference = Pose{q.toRotationMatrix(), t}.inverse() * actual;
        Eigen::Matrix<double, 6, 1> error;
        error << difference.t, Eigen::Quaterniond(difference.R).vec();
        EXPECT_NEAR(error.dot(information * error),
                    squaredMahalanobis(off, edge.covariance), 1e-6);
    }
    EXPECT_EQ(vertices, 3);
    EXPECT_EQ(edges, 2);
}

TEST(PoseGraph, RefusesEdgesOfNodesThatThereAreNot) {
    Ring ring(5);
    ring.graph.edges.push_back({1, 7, {{}, isotropic(1, 1)}, PoseEdge::Kind::closure});
    EXPECT_THROW(optimise(ring.graph), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm::slam
