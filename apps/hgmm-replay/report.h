#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/html_report.h"
#include "hgmm/evaluation/render.h"
#include "replay_scans.h"

namespace replay {

/// The figures of all maps of a run, ours first.
std::vector<hgmm::evaluation::MapFigures> evaluateReplayed(const Replayed& replayed);

/// Those of the baselines alone.
std::vector<hgmm::evaluation::MapFigures> evaluateBaselines(const Replayed& replayed);

/// Those of our surface model alone (hgmm::evaluation::evaluateSurface).
hgmm::evaluation::MapFigures evaluateSurfaceOf(const Replayed& replayed);

/// Writes metrics.json and report.html, and, where occupancy was evaluated, roc.svg,
/// reliability.svg and levels.svg. Throws std::runtime_error naming the file that cannot be
/// written.
void writeReport(const Replayed& replayed,
                 const std::vector<hgmm::evaluation::MapFigures>& maps,
                 const std::string& folder,
                 const std::vector<hgmm::evaluation::ReportPicture>& pictures);

/// How pictures of reports look at maps: into rooms, at what is outdoors.
hgmm::evaluation::View reportView(hgmm::evaluation::SensorKind sensor);

/// What the maps were given.
hgmm::evaluation::ReportPicture pictureOfInput(const Replayed& replayed,
                                               const hgmm::evaluation::View& view,
                                               const hgmm::evaluation::Frame& frame);

/// The input, and beside it the map as ellipsoids.
std::vector<hgmm::evaluation::ReportPicture> picturesOf(const Replayed& replayed);

}  // namespace replay
