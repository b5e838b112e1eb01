#pragma once
#include "options.h"

namespace replay {

/// How soon maps notice that the world has changed, and whether they stay right where it
/// has not: a simulated room in which things are removed, appear and move, and doors swing.
/// Ours beside --baselines; --only, --sensors, --seeds and
/// --after choose. Prints a table for each protocol, worst over seeds, and, with a report
/// folder, writes metrics.json there. Throws std::invalid_argument for a protocol or sensor
/// that there is not.
void dynamicsStudy(const Options& options);

}  // namespace replay
