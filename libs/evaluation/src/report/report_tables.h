#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"

namespace hgmm::evaluation {

/// HTML tables of how well the maps know what is occupied, and of what they cost. The best
/// of each column is in bold: among ranked maps, if several have a figure; all of those
/// that read the same. Maps that do not compete are listed below a line, with the reason.
std::string accuracyTable(const std::vector<MapFigures>& maps);
std::string costTable(const std::vector<MapFigures>& maps);

}  // namespace hgmm::evaluation
