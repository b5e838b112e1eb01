#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include <functional>
#include <sstream>

#include "edited_options.h"
#include "options/warnings.h"

using mrpt::config::CConfigFileMemory;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::maps::TSetOfMetricMapInitializers;

namespace {

/// What throws when `section` with one line is read into default options.
template <typename Options>
std::string errorOf(const std::string& line) {
    const CConfigFileMemory config(std::string("[s]\n") + line + "\n");
    Options options;
    try {
        options.loadFromConfigFile(config, "s");
    } catch (const std::invalid_argument& e) {
        EXPECT_EQ(edited::values(options), edited::values(Options()))
            << "half a read: " << line;
        return e.what();
    }
    return "";
}

template <typename T>
class Options : public ::testing::Test {};
using AllOptions = ::testing::Types<CHGMMOccupancyMap::TInsertionOptions,
                                    CHGMMOccupancyMap::TLikelihoodOptions,
                                    CHGMMOccupancyMap::TRenderOptions>;
TYPED_TEST_SUITE(Options, AllOptions);

TYPED_TEST(Options, EveryValueTakesPartInTheRoundTrip) {
    TypeParam written;
    const auto defaults = edited::values(written);
    edited::change(written);
    const auto expected = edited::values(written);
    ASSERT_EQ(defaults.size(), expected.size());
    for (const auto& [name, value] : expected) EXPECT_NE(value, defaults.at(name)) << name;

    CConfigFileMemory config;
    written.saveToConfigFile(config, "s");
    TypeParam read;
    read.loadFromConfigFile(config, "s");
    EXPECT_EQ(edited::values(read), expected);

    std::ostringstream text;
    written.dumpToTextStream(text);
    for (const auto& field : expected)
        EXPECT_NE(text.str().find(field.first + " = "), std::string::npos) << field.first;
}

TYPED_TEST(Options, SilenceKeepsValues) {
    TypeParam options;
    edited::change(options);
    const auto before = edited::values(options);
    options.loadFromConfigFile(CConfigFileMemory(), "absent");
    EXPECT_EQ(edited::values(options), before);
}

TEST(OptionErrors, BadValueNamesSectionKeyAndValue) {
    using Insertion = CHGMMOccupancyMap::TInsertionOptions;
    using Likelihood = CHGMMOccupancyMap::TLikelihoodOptions;
    using Render = CHGMMOccupancyMap::TRenderOptions;
    for (const std::string value : {"abc", "", "1.5x", "nan", "inf", "-3", "1e400"}) {
        const std::string said = errorOf<Insertion>("minLeaf_m = " + value);
        EXPECT_NE(said.find("[s] minLeaf_m = "), std::string::npos)
            << value << ": " << said;
    }
    EXPECT_NE(errorOf<Insertion>("levels = 2.5").find("levels"), std::string::npos);
    EXPECT_NE(errorOf<Insertion>("levels = 0").find("levels"), std::string::npos);
    EXPECT_NE(errorOf<Insertion>("levels = 99999999999").find("levels"), std::string::npos);
    EXPECT_NE(errorOf<Likelihood>("outlierRatio = 1").find("outlierRatio"),
              std::string::npos);
    EXPECT_NE(errorOf<Likelihood>("maxPoints = -1").find("maxPoints"), std::string::npos);
    EXPECT_EQ(errorOf<Likelihood>("minRange_m = 90"),
              "[s] minRange_m = 90: must be in [0, 80], as maxRange_m is 80");
    EXPECT_NE(errorOf<Render>("drawVoxels = maybe").find("drawVoxels"), std::string::npos);
    EXPECT_NE(errorOf<Render>("colour = 5").find("colour"), std::string::npos);
    EXPECT_NE(errorOf<Render>("colour = height").find("colour"), std::string::npos);
    EXPECT_NE(errorOf<Render>("voxelResolution_m = -1").find("voxelResolution_m"),
              std::string::npos);
    EXPECT_NE(errorOf<Render>("minOccupied = 1").find("minOccupied"), std::string::npos);
    EXPECT_NE(errorOf<Render>("sigmas = 0").find("sigmas"), std::string::npos);
}

TEST(OptionErrors, CommentsAndSpellingsOfNumbersAreUnderstood) {
    CHGMMOccupancyMap::TInsertionOptions options;
    options.loadFromConfigFile(CConfigFileMemory(std::string(
                                   "[s]\nminLeaf_m = +2e-2 ; metres\nlevels = 3 # three\n"
                                   "leafAtOneMetre_m = 0.5 // half\n")),
                               "s");
    EXPECT_EQ(options.params.filter.minLeaf_m, 0.02);
    EXPECT_EQ(options.params.hierarchy.levels, 3);
    EXPECT_EQ(options.params.filter.resolution_m, 0.5);
}

TEST(Modalities, NamesAreSeparatedByCommasAndRgbIsShortForThree) {
    using NameList = std::vector<std::string>;
    for (const auto& [line, expected] :
         {std::pair{"modalities = rgb,intensity", NameList{"r", "g", "b", "intensity"}},
          std::pair{"modalities =   intensity ,  rgb\t; a comment",
                    NameList{"intensity", "r", "g", "b"}},
          std::pair{"modalities = water content", NameList{"water content"}},
          std::pair{"modalities = ", NameList{}},
          std::pair{"modalities =   // none", NameList{}},
          std::pair{"levels = 3", NameList{"b"}}}) {
        CHGMMOccupancyMap::TInsertionOptions options;
        options.params.modalities = {"b"};
        options.loadFromConfigFile(CConfigFileMemory(std::string("[s]\n") + line + "\n"),
                                   "s");
        EXPECT_EQ(options.params.modalities, expected) << line;
    }
}

TEST(Modalities, BadNamesAreRefusedWithSectionAndKey) {
    using Insertion = CHGMMOccupancyMap::TInsertionOptions;
    for (const std::string value :
         {"rgb,,intensity", ",", "intensity,", "rgb, r", "a,b,a", "1,2,3,4,5,6,7,8,9"}) {
        const std::string said = errorOf<Insertion>("modalities = " + value);
        EXPECT_NE(said.find("[s]"), std::string::npos) << value << ": " << said;
        EXPECT_NE(said.find("modalities"), std::string::npos) << value << ": " << said;
    }
}

// Such names would be others after a configuration file or an archive.
TEST(Modalities, NamesThatFilesCannotHoldAreRefused) {
    hgmm::MapParams params;
    for (const std::string name : {"a,b", "a;b", "a#b", "a//b", " a", "a ", "a\nb"}) {
        params.modalities = {name};
        EXPECT_THROW(params.validate(), std::invalid_argument) << name;
    }
    params.modalities = {"water content [%]"};
    EXPECT_NO_THROW(params.validate());
}

TEST(OptionErrors, MisspeltNamesAreReportedWithTheNearest) {
    const CConfigFileMemory config(std::string(
        "[m]\nhgmmMap_count = 1\n[m_hgmmMap_00_creationOpts]\nloadfile = x\n"
        "enableSaveAs3DObject = false\n[m_hgmmMap_00_insertOpts]\nmin_leaf_m = 0.1\n"
        "[m_hgmmMap_00_likelihoodOpts]\nmaxpoints = 3\n[m_hgmmMap_00_renderOpts]\nsigma = "
        "3\n"
        "[m_hgmmMap_00_insertionOpts]\nlevels = 2\n"));
    TSetOfMetricMapInitializers definitions;
    hgmm::mrpt_bridge::forgetWarnings();
    ::testing::internal::CaptureStderr();
    definitions.loadFromConfigFile(config, "m");
    const std::string said = ::testing::internal::GetCapturedStderr();
    for (const auto& [wrong, right] :
         {std::pair{"'loadfile'", "'load_file'"}, std::pair{"'min_leaf_m'", "'minLeaf_m'"},
          std::pair{"'maxpoints'", "'maxPoints'"}, std::pair{"'sigma'", "'sigmas'"},
          std::pair{"'m_hgmmMap_00_insertionOpts'", "'m_hgmmMap_00_insertOpts'"}}) {
        const auto at = said.find(wrong);
        ASSERT_NE(at, std::string::npos) << wrong << " in\n" << said;
        EXPECT_LT(said.find(right, at), said.find('\n', at)) << right << " in\n" << said;
    }
    EXPECT_EQ(said.find("enableSaveAs3DObject"), std::string::npos) << said;
    EXPECT_NE(said.find("section [m_hgmmMap_00_insertOpts]"), std::string::npos) << said;
}

TEST(MapDefinition, OptionsOfTheConfigurationReachTheMap) {
    CConfigFileMemory config;
    config.write("m", "hgmmMap_count", 1);
    config.write("m_hgmmMap_00_creationOpts", "enableObservationLikelihood", "false");
    CHGMMOccupancyMap wanted;
    edited::change(wanted.insertionOptions);
    edited::change(wanted.likelihoodOptions);
    edited::change(wanted.renderOptions);
    wanted.insertionOptions.saveToConfigFile(config, "m_hgmmMap_00_insertOpts");
    wanted.likelihoodOptions.saveToConfigFile(config, "m_hgmmMap_00_likelihoodOpts");
    wanted.renderOptions.saveToConfigFile(config, "m_hgmmMap_00_renderOpts");

    TSetOfMetricMapInitializers definitions;
    definitions.loadFromConfigFile(config, "m");
    const mrpt::maps::CMultiMetricMap maps(definitions);
    const auto map = maps.mapByClass<CHGMMOccupancyMap>();
    ASSERT_TRUE(map);
    EXPECT_EQ(edited::all(*map).size(), edited::all(wanted).size());
    EXPECT_EQ(edited::values(map->insertionOptions),
              edited::values(wanted.insertionOptions));
    EXPECT_EQ(edited::values(map->likelihoodOptions),
              edited::values(wanted.likelihoodOptions));
    EXPECT_EQ(edited::values(map->renderOptions), edited::values(wanted.renderOptions));
    EXPECT_FALSE(map->genericMapParams.enableObservationLikelihood);

    std::ostringstream text;
    definitions.dumpToTextStream(text);
    EXPECT_NE(text.str().find("kernelWidth_m"), std::string::npos);
}

}  // namespace
