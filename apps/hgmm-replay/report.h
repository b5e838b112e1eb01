#pragma once
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "options.h"
#include "replay_scans.h"
#include "report_page.h"

namespace replay {

/// The figures of all maps of a run, ours first.
std::vector<hgmm::evaluation::MapFigures> evaluateReplayed(const Replayed& replayed);

/// Those of the baselines alone.
std::vector<hgmm::evaluation::MapFigures> evaluateBaselines(const Replayed& replayed);

/// Those of our surface model alone (hgmm::evaluation::evaluateSurface).
hgmm::evaluation::MapFigures evaluateSurfaceOf(const Replayed& replayed);

/// What report.html lets one look at, in the report's folder.
constexpr const char* kReportMap = "map.hgmm";
constexpr const char* kReportPoints = "input.ply";

/// Writes the report of a run (writeReportFiles), with the map and some of the points that
/// it was given. Throws std::runtime_error naming the file that cannot be written.
void writeReport(const Replayed& replayed,
                 const std::vector<hgmm::evaluation::MapFigures>& maps,
                 const Options& options, const std::vector<PointPicture>& pictures = {});

}  // namespace replay
