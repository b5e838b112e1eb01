#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

namespace maptool {

/// Points of a file [m]: a CSV whose first line names its columns, x, y and z among them,
/// or a line "x y z" or "x,y,z" for each point. Empty lines and lines that begin with # do
/// not count. Throws std::runtime_error naming the file and the line.
std::vector<Eigen::Vector3d> readPoints(const std::string& file);

}  // namespace maptool
