#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Study free-space: the map ("slabs") beside the thesis' own free space ("perComponent",
/// ThesisFreeSpace) of the same scans and surfaces. Prints the figures of both side by
/// side, and of baselines; with a report folder, writes what a plain replay writes.
///
/// Throws std::runtime_error naming the recording if no scan was left for the map or the
/// test.
void freeSpaceStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
