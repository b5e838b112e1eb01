#include "hgmm/mrpt_bridge/option_list.h"

#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <map>
#include <string>

#include "edited_options.h"
#include "insertion_options.h"

using mrpt::config::CConfigFileMemory;
using mrpt::maps::CHGMMOccupancyMap;

namespace {

TEST(ResolutionInFiles, LengthsThatAFileDoesNotGiveFollow) {
    hgmm::MapParams wanted;
    wanted.setResolution(0.1);
    EXPECT_EQ(paramsOf("resolution_m = 0.1"), wanted);
    wanted.cells.minCell_m = 0.04;
    EXPECT_EQ(paramsOf("minCell_m = 0.04\nresolution_m = 0.1"), wanted);
    EXPECT_EQ(paramsOf("resolution_m = 0.1 // m\nminCell_m = 0.04"), wanted);
    EXPECT_EQ(paramsOf("resolution_m = 0.04"), hgmm::MapParams());
}

TEST(ResolutionInFiles, FormerNameSetsTheLeafOnly) {
    hgmm::MapParams wanted;
    wanted.filter.resolution_m = 0.1;
    EXPECT_EQ(paramsOf("leafAtOneMetre_m = 0.1"), wanted);
    wanted.carving.carvedSupport = 0.5;
    EXPECT_EQ(paramsOf("leafAtOneMetre_m = 0.1\ncontradictedKeep = 0.5"), wanted);
}

TEST(ResolutionInFiles, SavedOptionsGiveEveryLength) {
    CHGMMOccupancyMap::TInsertionOptions written, read;
    written.params.filter.resolution_m = 0.1;
    CConfigFileMemory config;
    written.saveToConfigFile(config, "s");
    read.params.setResolution(0.2);
    read.loadFromConfigFile(config, "s");
    EXPECT_EQ(read.params, written.params);
}

TEST(OptionList, HasAllOptionsAndAtMostEightBasicOnes) {
    std::size_t basic = 0;
    std::map<std::string, std::size_t> ofSection;
    for (const auto& option : hgmm::mrpt_bridge::listOptions()) {
        basic += option.isBasic ? 1 : 0;
        ++ofSection[option.section];
        if (option.name == "resolution_m") {
            EXPECT_EQ(option.defaultValue, "0.04");
            EXPECT_EQ(option.range, "0.005 to 10");
            EXPECT_EQ(option.formerName, "leafAtOneMetre_m");
            EXPECT_TRUE(option.isBasic);
        }
    }
    EXPECT_LE(basic, 8U);
    EXPECT_GE(basic, 5U);
    CHGMMOccupancyMap map;
    EXPECT_EQ(ofSection["insertOpts"], edited::values(map.insertionOptions).size());
    EXPECT_EQ(ofSection["likelihoodOpts"], edited::values(map.likelihoodOptions).size());
    EXPECT_EQ(ofSection["renderOpts"], edited::values(map.renderOptions).size());
    EXPECT_EQ(ofSection["creationOpts"], 4U);
}

}  // namespace
