#pragma once
#include <Eigen/Core>
#include <string>

namespace maptool {

/// Three finite numbers, parted by commas or blanks. Throws std::runtime_error starting
/// with `where` for anything else.
Eigen::Vector3d parsePoint(const std::string& text, const std::string& where);

}  // namespace maptool
