#include "hgmm/slam/pose_graph.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace hgmm::slam {
namespace {

/// Grows with the covariance: a radian is as bad as kMetresPerRadian.
double uncertaintyOf(const Matrix6d& covariance) {
    constexpr double kMetresPerRadian = 10.0;
    return covariance.bottomRightCorner<3, 3>().trace() +
           kMetresPerRadian * kMetresPerRadian * covariance.topLeftCorner<3, 3>().trace();
}

void appendPose(std::string& text, const Pose& pose) {
    Eigen::Quaterniond q(pose.R);
    if (q.w() < 0) q.coeffs() *= -1;
    char line[256];
    std::snprintf(line, sizeof line, " %.9f %.9f %.9f %.12f %.12f %.12f %.12f", pose.t.x(),
                  pose.t.y(), pose.t.z(), q.x(), q.y(), q.z(), q.w());
    text += line;
}

/// Information of g2o's error (t, q), q the vector part of the quaternion, in the axes of
/// the second node: w = 2 R q, v = R t.
Eigen::Matrix<double, 6, 6> g2oInformation(const UncertainPose& edge) {
    Eigen::Matrix<double, 6, 6> fromG2o = Eigen::Matrix<double, 6, 6>::Zero();
    fromG2o.topRightCorner<3, 3>() = 2.0 * edge.T_a_b.R;
    fromG2o.bottomLeftCorner<3, 3>() = edge.T_a_b.R;
    const Eigen::Matrix<double, 6, 6> covariance = edge.covariance;
    return fromG2o.transpose() * covariance.ldlt().solve(fromG2o);
}

constexpr double kGuess_m = 0.5, kGuess_rad = 0.2;

}  // namespace

bool isGuess(const UncertainPose& pose) {
    const Matrix6d& covariance = pose.covariance;
    return covariance.bottomRightCorner<3, 3>().diagonal().maxCoeff() >
               kGuess_m * kGuess_m ||
           covariance.topLeftCorner<3, 3>().diagonal().maxCoeff() > kGuess_rad * kGuess_rad;
}

void doubtOdometryTo(std::size_t node, PoseGraph& graph) {
    for (PoseEdge& edge : graph.edges) {
        if (edge.kind != PoseEdge::Kind::odometry || edge.to != node) continue;
        Matrix6d& covariance = edge.T_from_to.covariance;
        covariance.topLeftCorner<3, 3>().diagonal().array() += 4 * kGuess_rad * kGuess_rad;
        covariance.bottomRightCorner<3, 3>().diagonal().array() += 4 * kGuess_m * kGuess_m;
    }
}

std::size_t partsOf(const PoseGraph& graph) {
    const std::size_t n = graph.T_world_node.size();
    std::vector<std::size_t> part(n);
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (const PoseEdge& edge : graph.edges) {
        if (isGuess(edge.T_from_to)) continue;
        const std::size_t kept = part[edge.from], joined = part[edge.to];
        std::replace(part.begin(), part.end(), joined, kept);
    }
    std::sort(part.begin(), part.end());
    return static_cast<std::size_t>(std::unique(part.begin(), part.end()) - part.begin());
}

std::vector<UncertainPose> poseOfAll(const PoseGraph& graph, std::size_t from) {
    const std::size_t n = graph.T_world_node.size();
    std::vector<std::vector<std::size_t>> edgesOf(n);
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
        edgesOf[graph.edges[e].from].push_back(e);
        edgesOf[graph.edges[e].to].push_back(e);
    }
    std::vector<UncertainPose> seen(n);
    std::vector<double> best(n, std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> open;
    best.at(from) = 0.0;
    open.emplace(0.0, from);
    while (!open.empty()) {
        const auto [uncertainty, node] = open.top();
        open.pop();
        if (uncertainty > best[node]) continue;
        for (const std::size_t e : edgesOf[node]) {
            const PoseEdge& edge = graph.edges[e];
            const std::size_t other = edge.from == node ? edge.to : edge.from;
            UncertainPose step =
                edge.from == node ? edge.T_from_to : edge.T_from_to.inverse();
            step.T_a_b = graph.T_world_node[node].inverse() * graph.T_world_node[other];
            const UncertainPose longer = seen[node] * step;
            const double grown = uncertaintyOf(longer.covariance);
            if (grown >= best[other]) continue;
            best[other] = grown;
            seen[other] = longer;
            open.emplace(grown, other);
        }
    }
    return seen;
}

std::string g2oText(const PoseGraph& graph) {
    std::string text;
    for (std::size_t i = 0; i < graph.T_world_node.size(); ++i) {
        text += "VERTEX_SE3:QUAT " + std::to_string(i);
        appendPose(text, graph.T_world_node[i]);
        text += '\n';
    }
    if (!graph.T_world_node.empty()) text += "FIX 0\n";
    for (const PoseEdge& edge : graph.edges) {
        text +=
            "EDGE_SE3:QUAT " + std::to_string(edge.from) + ' ' + std::to_string(edge.to);
        appendPose(text, edge.T_from_to.T_a_b);
        const Eigen::Matrix<double, 6, 6> information = g2oInformation(edge.T_from_to);
        for (int row = 0; row < 6; ++row)
            for (int col = row; col < 6; ++col) {
                char number[32];
                std::snprintf(number, sizeof number, " %.9g", information(row, col));
                text += number;
            }
        text += '\n';
    }
    return text;
}

}  // namespace hgmm::slam
