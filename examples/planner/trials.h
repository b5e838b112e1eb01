#pragma once
#include <string>
#include <vector>

#include "free_space.h"
#include "planning.h"

namespace planner {

/// A path and what it took.
struct Plan {
    Eigen::Vector3d start_map, goal_map;  ///< [m]
    Path path_map;                        ///< empty: none was found
    double milliseconds = 0.0;
};

/// Searches and smooths.
Plan timedPlan(const FreeSpace& space, const Eigen::Vector3d& start_map,
               const Eigen::Vector3d& goal_map, const PlanningParams& params);

/// Plans between places that are free and at least `apart_m` from each other. Throws
/// std::runtime_error if there are no such places.
std::vector<Plan> randomPlans(const FreeSpace& space, unsigned count, double apart_m,
                              const PlanningParams& params);

/// Prints a line for each plan.
void printTable(const FreeSpace& space, const std::vector<Plan>& plans);

/// Columns plan,x,y,z. Throws std::runtime_error if the file cannot be written.
void writeCsv(const std::vector<Plan>& plans, const std::string& file);

}  // namespace planner
