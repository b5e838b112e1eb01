#pragma once
#include <string>

#include "hgmm/evaluation/figures.h"

namespace replay {

/// The figures of a run for a reader: levels, memory, times and accuracy.
std::string table(const hgmm::evaluation::Run& run, const hgmm::evaluation::MapFigures& map,
                  const hgmm::evaluation::Timing& conversion_ms);

}  // namespace replay
