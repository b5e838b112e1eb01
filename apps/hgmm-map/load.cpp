#include "load.h"

#include <stdexcept>

#include "hgmm/mrpt_bridge/modality_colours.h"

namespace maptool {

mrpt::maps::CHGMMOccupancyMap loadMap(const std::string& file) {
    mrpt::maps::CHGMMOccupancyMap map;
    map.loadFromFile(file);
    return map;
}

const hgmm::Mixture<3>& levelOf(const hgmm::Map& map, std::size_t level,
                                const std::string& file) {
    if (map.empty() && map.coverageBytes() == 0)
        throw std::runtime_error(file + ": the map is empty");
    if (level >= map.levelCount())
        throw std::runtime_error(file + ": has no level " + std::to_string(level) +
                                 "; its levels are 0 to " +
                                 std::to_string(map.levelCount() - 1));
    return map.mixture(level);
}

std::vector<std::string> modalitiesOf(const hgmm::Map& map,
                                      const std::vector<std::string>& wanted,
                                      const std::string& file) {
    std::vector<std::string> names;
    for (const std::string& one : wanted) {
        const auto shown = hgmm::mrpt_bridge::shownModalities(map, one);
        names.insert(names.end(), shown.begin(), shown.end());
        if (!shown.empty()) continue;
        if (map.modalities().empty())
            throw std::runtime_error(
                file + ": has no modalities; build it with insertOpts modalities = rgb");
        std::string known;
        for (const std::string& name : map.modalities())
            known += (known.empty() ? "" : ", ") + name;
        throw std::runtime_error(file + ": has no modality '" + one + "'; it has " + known);
    }
    return names;
}

}  // namespace maptool
