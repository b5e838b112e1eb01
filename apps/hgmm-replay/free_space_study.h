#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Study free-space: the recording, mapped once with each model of free space
/// (hgmm::FreeSpaceModel) and otherwise equal parameters. Prints the figures of both side
/// by side, and of baselines; with a report folder, writes what a plain replay writes.
///
/// Queries of a perComponent map visit many components, and take long on a large map.
/// Throws std::runtime_error naming the recording if no scan was left for the map or the
/// test.
void freeSpaceStudy(hgmm::evaluation::Recording& recording,
                    const hgmm::evaluation::RecordingOptions& recordingOptions,
                    const Options& options);

}  // namespace replay
