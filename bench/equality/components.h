#pragma once
#include "dump.h"
#include "hgmm/map.h"

namespace equality {

/// Adds what a map consists of, at every level: its origin, the arrays of surfaces, view
/// directions, free space and modalities.
void addComponents(Dump& dump, const hgmm::Map& map);

}  // namespace equality
