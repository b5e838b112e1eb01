#pragma once
#include <string>

#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"

namespace hgmm::mrpt_bridge {

/// Reports modalities of a section that no observation of MRPT can bring, with the one that
/// was probably meant: scans of another origin may have them.
void warnOfForeignModalities(const Names& modalities, const std::string& section);

/// Reports that a scan has channels and none of them is a modality of the map, which knows
/// none of its modalities yet.
void warnOfAbsentModalities(const Map& map, const Scan& scan);

}  // namespace hgmm::mrpt_bridge
