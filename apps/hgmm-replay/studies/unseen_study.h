#pragma once
#include "options.h"

namespace replay {

/// What maps say of space that no ray passed, and of space that rays passed without a
/// return: points inside solids and behind the walls of a simulated room (--only solids),
/// and a laser in a hall that is wider than its range (--only hall). Ours beside
/// --baselines; --sensors,
/// --seeds and --after, the number of scans in the room, choose. Prints a table for each
/// and, with a report folder, writes metrics.json there. Throws std::invalid_argument for a
/// part or sensor that there is not.
void unseenStudy(const Options& options);

}  // namespace replay
