#pragma once
#include <mrpt/obs/CObservation.h>

namespace hgmm::importer {

/// Loads what an observation keeps in files beside its log, and keeps it in memory from
/// then on: what is written of it needs no other files. Throws std::exception if a file
/// cannot be read.
void embed(mrpt::obs::CObservation& observation);

}  // namespace hgmm::importer
