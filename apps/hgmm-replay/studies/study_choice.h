#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/map_under_test.h"
#include "options.h"

namespace replay {

/// Empty maps for one run, ours first.
using MakeMaps =
    std::function<std::vector<std::unique_ptr<hgmm::evaluation::MapUnderTest>>()>;

/// Ours as --config has it, and beside it --baselines with cells as fine as indoors.
MakeMaps mapsOf(const Options& options);

/// The names that a user wants, or all that are known if there are none. Throws
/// std::invalid_argument, naming the option and listing the names, for one that is not
/// known.
std::vector<std::string> chosen(const char* option, const std::vector<std::string>& wanted,
                                const std::vector<std::string>& known);

bool contains(const std::vector<std::string>& names, const std::string& name);

/// Runs jobs one after another and tells how far it is, until the end or Ctrl-C.
void runJobs(const std::vector<std::function<void()>>& jobs, bool quiet);

}  // namespace replay
