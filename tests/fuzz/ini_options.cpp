// Configuration files: the bytes are an ini text.
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <string>

#include "harness.h"
#include "oracle.h"

namespace hgmm::fuzz {

void runOne(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    // What names a file is not tried: it would be read.
    if (text.find("load_file") != std::string::npos) return;
    auto one = std::make_shared<mrpt::maps::CHGMMOccupancyMap::TMapDefinition>();
    try {
        const mrpt::config::CConfigFileMemory config("[map_creation]\n" + text);
        one->loadFromConfigFile(config, "map");
    } catch (const std::exception&) {
        return;
    }
    one->insertionOpts.params.validate();
    mrpt::config::CConfigFileMemory config;
    one->insertionOpts.saveToConfigFile(config, "s");
    one->likelihoodOpts.saveToConfigFile(config, "t");
    one->renderOpts.saveToConfigFile(config, "u");
    mrpt::maps::CHGMMOccupancyMap::TMapDefinition again;
    again.insertionOpts.loadFromConfigFile(config, "s");
    again.likelihoodOpts.loadFromConfigFile(config, "t");
    again.renderOpts.loadFromConfigFile(config, "u");
    require(again.insertionOpts.params == one->insertionOpts.params &&
                again.insertionOpts.reading == one->insertionOpts.reading &&
                again.likelihoodOpts == one->likelihoodOpts &&
                again.renderOpts == one->renderOpts,
            "options that were read are written and read again");
}

}  // namespace hgmm::fuzz
