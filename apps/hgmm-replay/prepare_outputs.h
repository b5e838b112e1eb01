#pragma once
#include "options.h"

namespace replay {

/// Files that cannot be written at the end of a long run had better be known at its start:
/// makes the report's folder, and throws std::runtime_error if it or the map cannot be
/// written, or would replace an input or what is no such file.
void prepareOutputs(const Options& options);

}  // namespace replay
