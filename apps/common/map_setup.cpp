#include "map_setup.h"

#include <mrpt/config/CConfigFile.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace replay {

using mrpt::maps::CHGMMOccupancyMap;

CHGMMOccupancyMap::Ptr makeMap(const std::optional<std::string>& config) {
    CHGMMOccupancyMap::TMapDefinition definition;
    if (config) {
        if (!std::filesystem::is_regular_file(*config))
            throw std::runtime_error(*config + ": there is no such configuration file");
        const mrpt::config::CConfigFile ini(*config);
        std::vector<std::string> sections;
        ini.getAllSections(sections);
        int maps = 0;
        std::string prefix;
        for (const std::string& section : sections) {
            const int count = ini.read_int(section, "hgmmMap_count", 0);
            if (count > 0) prefix = section + "_hgmmMap_00";
            maps += count;
        }
        if (maps != 1)
            throw std::runtime_error(*config + ": describes " + std::to_string(maps) +
                                     " hgmm maps; one section must have hgmmMap_count = 1");
        definition.loadFromConfigFile(ini, prefix);
    }
    return CHGMMOccupancyMap::Ptr(CHGMMOccupancyMap::CreateFromMapDefinition(definition));
}

}  // namespace replay
