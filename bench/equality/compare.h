#pragma once
#include <cstddef>
#include <string>

#include "dump.h"

namespace equality {

/// Prints what was compared and `equal`, or the first different number of each section that
/// differs. Numbers are compared bit by bit. Returns whether all are equal, and there are
/// some.
bool compare(const std::string& recording, const Dump& base, const Dump& present);

/// Moves one float by one unit in its last place. Throws std::runtime_error for a section,
/// column or row that does not exist, or one that holds no floats.
void plant(Dump& dump, const std::string& section, const std::string& column,
           std::size_t row);

}  // namespace equality
