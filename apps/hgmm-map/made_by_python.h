#pragma once
#include <string>
#include <vector>

namespace maptool {

/// What a program of the Python package writes (hgmm::evaluation::runPython). Its warnings
/// go to standard error. Throws std::runtime_error with its own reason if it fails.
std::string madeByPython(const std::string& module,
                         const std::vector<std::string>& arguments);

}  // namespace maptool
