#pragma once
#include <cstdint>

#include "hgmm/evaluation/planar_observation.h"
#include "studies/figure_table.h"
#include "studies/study_choice.h"

namespace replay {

/// The table of the hall.
FigureTable hallTable();

/// Maps of a hall of 60 x 40 m with a pillar, from 120 scans of a laser on a way of 30 m,
/// and what they say of points that rays passed, and of the ends of rays without a return.
/// Beside the others stands MRPT's 2D grid, as it comes and without
/// `considerInvalidRangesAsFreeSpace`.
/// @param limit_m range of the laser [m]
void studyHall(double limit_m, hgmm::evaluation::NoReturn noReturn, std::uint64_t seed,
               const MakeMaps& makeMaps, FigureTable& table);

}  // namespace replay
