#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "hgmm/slam/pose_graph.h"

namespace hgmm::slam {
namespace {

/// A node as Ceres moves it.
struct NodeState {
    explicit NodeState(const Pose& pose) : q(pose.R), t(pose.t) {}
    Pose pose() const { return {q.normalized().toRotationMatrix(), t}; }

    Eigen::Quaterniond q;
    Eigen::Vector3d t;
};

/// The whitened error (w, v) of an edge, as in UncertainPose. The rotation vector is twice
/// the vector part of the quaternion, which keeps the gradient finite at 0.
struct EdgeError {
    explicit EdgeError(const PoseEdge& edge)
        : q_measured(edge.T_from_to.T_a_b.R), t_measured(edge.T_from_to.T_a_b.t) {
        const Eigen::Matrix<double, 6, 6> covariance = edge.T_from_to.covariance;
        const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(covariance);
        if (factor.info() != Eigen::Success)
            throw std::invalid_argument("covariance of an edge: is not positive definite");
        whitening = factor.matrixL().solve(Eigen::Matrix<double, 6, 6>::Identity());
    }

    template <typename T>
    bool operator()(const T* qFrom, const T* tFrom, const T* qTo, const T* tTo,
                    T* residuals) const {
        using Quaternion = Eigen::Quaternion<T>;
        using Vector = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Quaternion> q_from(qFrom), q_to(qTo);
        const Eigen::Map<const Vector> t_from(tFrom), t_to(tTo);
        const Quaternion back = q_from.conjugate();
        const Quaternion off = back * q_to * q_measured.conjugate().template cast<T>();
        Eigen::Matrix<T, 6, 1> error;
        error.template head<3>() = (off.w() < T(0) ? T(-2) : T(2)) * off.vec();
        error.template tail<3>() =
            back * Vector(t_to - t_from) - t_measured.template cast<T>();
        Eigen::Map<Eigen::Matrix<T, 6, 1>> whitened(residuals);
        whitened = whitening.template cast<T>() * error;
        return true;
    }

    Eigen::Quaterniond q_measured;
    Eigen::Vector3d t_measured;
    Eigen::Matrix<double, 6, 6> whitening;
};

void checkEdges(const PoseGraph& graph) {
    for (const PoseEdge& edge : graph.edges)
        if (std::max(edge.from, edge.to) >= graph.T_world_node.size())
            throw std::invalid_argument("edge of a pose graph: there is no such node");
}

/// First and last node of the loops that the new closures end, with all that other closures
/// tie to them; first == last where there are none.
struct Loops {
    Loops(const PoseGraph& graph, std::size_t firstNewEdge) {
        first = graph.T_world_node.size();
        for (std::size_t e = firstNewEdge; e < graph.edges.size(); ++e)
            if (graph.edges[e].kind == PoseEdge::Kind::closure) take(graph.edges[e]);
        if (last <= first) {
            first = last = 0;
            return;
        }
        for (bool grown = true; grown;) {
            grown = false;
            for (const PoseEdge& edge : graph.edges)
                if (edge.kind == PoseEdge::Kind::closure && overlaps(edge))
                    grown = take(edge) || grown;
        }
    }

    /// Whether a closure spans a part of them, not only a node at their end.
    bool overlaps(const PoseEdge& edge) const {
        return std::min(edge.from, edge.to) < last && std::max(edge.from, edge.to) > first;
    }
    bool holds(const PoseEdge& edge) const {
        return std::min(edge.from, edge.to) >= first &&
               std::max(edge.from, edge.to) <= last;
    }

    std::size_t first = 0, last = 0;

 private:
    bool take(const PoseEdge& edge) {
        const std::size_t low = std::min(edge.from, edge.to);
        const std::size_t high = std::max(edge.from, edge.to);
        const bool grows = low < first || high > last;
        first = std::min(first, low);
        last = std::max(last, high);
        return grows;
    }
};

}  // namespace

void OptimisationParams::validate() const {
    if (!(kernelWidth > 0)) throw std::invalid_argument("kernelWidth: must be positive");
    if (maxIterations < 1) throw std::invalid_argument("maxIterations: must be at least 1");
}

Optimisation optimise(PoseGraph& graph, std::size_t firstNewEdge,
                      const OptimisationParams& params) {
    params.validate();
    checkEdges(graph);
    const Loops loops(graph, firstNewEdge);
    if (loops.first == loops.last) return {};
    std::vector<NodeState> states;
    for (std::size_t i = loops.first; i <= loops.last; ++i)
        states.emplace_back(graph.T_world_node[i]);

    ceres::Problem::Options ownership;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::EigenQuaternionManifold rotations;
    ceres::CauchyLoss kernel(params.kernelWidth);
    ceres::Problem problem(ownership);
    for (NodeState& state : states) {
        problem.AddParameterBlock(state.q.coeffs().data(), 4, &rotations);
        problem.AddParameterBlock(state.t.data(), 3);
    }
    for (const PoseEdge& edge : graph.edges) {
        if (!loops.holds(edge)) continue;
        NodeState& from = states[edge.from - loops.first];
        NodeState& to = states[edge.to - loops.first];
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<EdgeError, 6, 4, 3, 4, 3>(new EdgeError(edge)),
            edge.kind == PoseEdge::Kind::closure ? &kernel : nullptr,
            from.q.coeffs().data(), from.t.data(), to.q.coeffs().data(), to.t.data());
    }
    problem.SetParameterBlockConstant(states.front().q.coeffs().data());
    problem.SetParameterBlockConstant(states.front().t.data());

    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = params.maxIterations;
    options.num_threads = 1;  // sums in one order
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);

    const Pose lastBefore = graph.T_world_node[loops.last];
    for (std::size_t i = loops.first; i <= loops.last; ++i)
        graph.T_world_node[i] = states[i - loops.first].pose();
    const Pose moved = graph.T_world_node[loops.last] * lastBefore.inverse();
    for (std::size_t i = loops.last + 1; i < graph.T_world_node.size(); ++i) {
        Pose& pose = graph.T_world_node[i];
        pose = moved * pose;
        pose.R = orthonormal(pose.R);
    }
    return {loops.last - loops.first, static_cast<int>(summary.iterations.size()),
            summary.final_cost};
}

}  // namespace hgmm::slam
