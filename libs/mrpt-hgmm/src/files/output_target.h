#pragma once
#include <string>

#include "hgmm/mrpt_bridge/output_file.h"

namespace hgmm::mrpt_bridge {

/// Where an output goes.
struct OutputTarget {
    std::string file;       ///< its symbolic links followed
    bool isDirect = false;  ///< a device, a pipe or a descriptor: no file to be replaced
};

/// Follows symbolic links, also one to a file that is not there yet. Throws
/// std::runtime_error for links in a circle.
OutputTarget targetOf(const std::string& file);

/// The folder that a file is in, "." for a name alone.
std::string folderOf(const std::string& file);

/// Removes what processes that were killed have left beside a target, and says so.
void removeLeftovers(const std::string& target);

/// Throws std::runtime_error "FILE: WHAT".
[[noreturn]] void failOutput(const std::string& file, const std::string& what);

}  // namespace hgmm::mrpt_bridge
