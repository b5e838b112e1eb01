#include "load.h"

#include <stdexcept>

namespace maptool {

mrpt::maps::CHGMMOccupancyMap loadMap(const std::string& file) {
    mrpt::maps::CHGMMOccupancyMap map;
    map.loadFromFile(file);
    return map;
}

const hgmm::Mixture<3>& levelOf(const hgmm::Map& map, std::size_t level,
                                const std::string& file) {
    if (map.empty()) throw std::runtime_error(file + ": the map is empty");
    if (level >= map.levelCount())
        throw std::runtime_error(file + ": has no level " + std::to_string(level) +
                                 "; its levels are 0 to " +
                                 std::to_string(map.levelCount() - 1));
    return map.mixture(level);
}

}  // namespace maptool
