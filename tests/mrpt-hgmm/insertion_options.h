#pragma once
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <string>

/// Parameters as the lines of a section `_insertOpts` give them.
inline hgmm::MapParams paramsOf(const std::string& lines) {
    mrpt::maps::CHGMMOccupancyMap::TInsertionOptions options;
    options.loadFromConfigFile(mrpt::config::CConfigFileMemory("[s]\n" + lines + "\n"),
                               "s");
    return options.params;
}
