#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Studies that compare maps of one run. Those with other maps take their usual ones unless
/// --baselines names some. Each prints a table and, with a report folder, writes the report
/// of its run there. Ctrl-C ends a run early: what is printed is then of the scans so far.
/// All throw std::runtime_error naming the recording if no scan was left to build a map
/// from.

/// Thesis fig. 3.5: the surface model alone against NDT with cells of 5, 10 and 15 cm (four
/// times that for lidars), test points scored by likelihood.
void ndtStudy(hgmm::evaluation::Recording& recording, const Options& options);

/// Thesis fig. 4.1: occupancy against OctoMap, NDT-OM and GPOctoMap.
void occupancyStudy(hgmm::evaluation::Recording& recording, const Options& options);

/// Thesis fig. 4.2: accuracy, size and divergence of each level.
void levelsStudy(hgmm::evaluation::Recording& recording, const Options& options);

/// Thesis table 4.1: memory in all and per scan, of the same maps as fig. 4.1.
void memoryStudy(hgmm::evaluation::Recording& recording, const Options& options);

/// Thesis 4.4.5: scans per second from observation to updated map, with --threads threads.
void realtimeStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
