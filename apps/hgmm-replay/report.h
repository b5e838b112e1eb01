#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "replay_scans.h"

namespace replay {

/// The figures of all maps of a run, ours first.
std::vector<hgmm::evaluation::MapFigures> evaluateReplayed(const Replayed& replayed);

/// Writes metrics.json, and, where occupancy was evaluated, roc.svg, reliability.svg and
/// levels.svg. Throws std::runtime_error naming the file that cannot be written.
void writeReport(const hgmm::evaluation::Run& run,
                 const std::vector<hgmm::evaluation::MapFigures>& maps,
                 const std::string& folder);

}  // namespace replay
