#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Study room: a recording of an empty box room by a simulated sensor without noise, whose
/// walls are the box around its points. The map is built from scans with range noise and
/// asked, as loaded back from its bytes, for the walls, the free space before them and the
/// unknown behind them. Prints the shares of right answers; with a report folder, writes
/// room.json.
///
/// Throws std::runtime_error naming the recording if it is not of such a room, or no scan
/// was left for the map or the test.
void roomStudy(hgmm::evaluation::Recording& recording,
               const hgmm::evaluation::RecordingOptions& recordingOptions,
               const Options& options);

}  // namespace replay
