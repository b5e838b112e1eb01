#pragma once
#include "options.h"

namespace replay {

/// Whether the map of a robot grows that stays where it is in a simulated room: components
/// and bytes after 10, 100, 1000 and 4000 scans and at the end, with range noise of 1 and 2
/// cm, with dust and without. A partition appears 1000 scans before the end: how soon is it
/// there? --sensors, --seeds, --after (scans in all) and --baselines choose, and --only:
/// clean, dust. Prints a table, worst over seeds, and, with a report folder, writes
/// metrics.json there. Throws std::invalid_argument for a part or sensor that there is not.
void parkedStudy(const Options& options);

}  // namespace replay
