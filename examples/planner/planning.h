#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "free_space.h"

namespace planner {

struct PlanningParams {
    /// Iterations of RRT* once there is a path: they make it shorter and clearer.
    unsigned improvements = 1000;
    /// There is no path if so many do not find one.
    unsigned maxIterations = 50000;
    double step_m = 2.0;  ///< longest edge of the tree [m], > 0
};

/// Random numbers of all planning from now on.
void setSeed(std::uint_fast32_t seed);

/// A path of RRT* that is short and keeps away from surfaces; empty if there is none.
/// Throws std::invalid_argument if the robot cannot be at one of the ends.
Path plan(const FreeSpace& space, const Eigen::Vector3d& start_map,
          const Eigen::Vector3d& goal_map, const PlanningParams& params = {});

}  // namespace planner
