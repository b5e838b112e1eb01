#pragma once
#include <cstdint>
#include <string>

#include "hgmm/evaluation/solid_room.h"
#include "studies/figure_table.h"
#include "studies/study_choice.h"

namespace replay {

/// The table of the room with solids.
FigureTable solidsTable();

/// Maps of the room from `scans` poses, and what they say of its solids.
/// @param sensor as observerOf takes it
void studySolids(const std::string& sensor, hgmm::evaluation::solid_room::Route route,
                 int scans, std::uint64_t seed, const MakeMaps& makeMaps,
                 FigureTable& table);

}  // namespace replay
