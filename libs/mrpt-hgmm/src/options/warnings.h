#pragma once
#include <string>
#include <vector>

namespace hgmm::mrpt_bridge {

/// Writes "[hgmm] warning: text" to stderr, once in a process: programs read one
/// configuration several times, and particles hold copies of one map. Remembers the last
/// texts only, so that its memory is bounded. May be called from several threads.
void warn(const std::string& text);

/// Lets every warning be said again. For tests.
void forgetWarnings();

/// Whether two texts are equal but for case. MRPT finds sections and keys like this.
bool equalsIgnoringCase(const std::string& a, const std::string& b);
std::string lowerCase(std::string text);

/// Number of single-character edits between two names, case ignored.
std::size_t editDistance(const std::string& a, const std::string& b);

/// The one of `known`, which is not empty, with fewest edits.
const std::string& nearestName(const std::string& name,
                               const std::vector<std::string>& known);

/// "a, b, c"
std::string listed(const std::vector<std::string>& names);

}  // namespace hgmm::mrpt_bridge
