#pragma once
#include <string>

#include "dump.h"
#include "hgmm/map.h"

namespace equality {

/// Adds what a map consists of, at every level: its origin, the arrays of surfaces, view
/// directions, free space and modalities. `of` goes before the names.
void addComponents(Dump& dump, const std::string& of, const hgmm::Map& map);

}  // namespace equality
