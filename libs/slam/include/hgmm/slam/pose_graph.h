#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "hgmm/slam/uncertain_pose.h"

namespace hgmm::slam {

/// A measured pose of one node in the frame of another.
struct PoseEdge {
    enum class Kind {
        odometry,  ///< between a node and the next: always right
        closure    ///< found by its looks: may be wrong, and has a robust kernel
    };

    std::size_t from = 0, to = 0;  ///< nodes
    UncertainPose T_from_to;       ///< covariance positive definite
    Kind kind = Kind::odometry;
};

/// Whether a pose is so uncertain that it joins nothing: by more than half a metre, or 12
/// deg, one standard deviation.
bool isGuess(const UncertainPose& pose);

/// Poses of submaps and what was measured between them. Node 0 is where it was put.
struct PoseGraph {
    std::vector<Pose> T_world_node;
    std::vector<PoseEdge> edges;  ///< node i + 1 has an odometry edge from node i
};

/// Makes the odometry edge to a node a guess, for its other edges to hold it; of no effect
/// without one.
void doubtOdometryTo(std::size_t node, PoseGraph& graph);

struct OptimisationParams {
    /// Closures that are off by more than this count less and less (Cauchy's kernel): a
    /// squared Mahalanobis distance of 6 is to be expected [sigma], > 0.
    double kernelWidth = 4.0;
    int maxIterations = 50;  ///< of Levenberg and Marquardt [count], >= 1

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// What optimisation did.
struct Optimisation {
    std::size_t nodes = 0;  ///< that could move
    int iterations = 0;
    double cost = 0.0;  ///< half the sum of squared errors, after the kernel
};

/// Moves the nodes to where edges agree best: maximum likelihood, with a robust kernel for
/// closures. Only what a closure from `firstNewEdge` on can move takes part: the loops that
/// new closures end, with the closures across them. Nodes before stay; those behind follow
/// rigidly. Deterministic. Throws std::invalid_argument for edges of nodes that there are
/// not.
Optimisation optimise(PoseGraph& graph, std::size_t firstNewEdge = 0,
                      const OptimisationParams& params = {});

/// How node `from` sees all others: by the most certain chain of edges, a bound from above
/// that needs no inverse of the whole graph (the least uncertain path: Dijkstra over the
/// growth of the covariance). The poses are those of the nodes.
std::vector<UncertainPose> poseOfAll(const PoseGraph& graph, std::size_t from);

/// Groups of nodes that edges hold together which are no guesses [count].
std::size_t partsOf(const PoseGraph& graph);

/// The graph in the text format of g2o: VERTEX_SE3:QUAT, FIX and EDGE_SE3:QUAT, with the
/// information of (t, q) in the measured frame of the second node.
std::string g2oText(const PoseGraph& graph);

}  // namespace hgmm::slam
