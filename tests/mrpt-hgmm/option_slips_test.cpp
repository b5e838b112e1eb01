#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "edited_options.h"
#include "hgmm/mrpt_bridge/option_list.h"
#include "insertion_options.h"
#include "options/warnings.h"

using mrpt::config::CConfigFileMemory;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::maps::TSetOfMetricMapInitializers;

namespace {

const std::string kOneMap = "[m]\nhgmmMap_count = 1\n";

/// What a whole configuration with the parent section [m] makes programs say on stderr.
std::string saidOf(const std::string& text) {
    TSetOfMetricMapInitializers definitions;
    hgmm::mrpt_bridge::forgetWarnings();
    ::testing::internal::CaptureStderr();
    definitions.loadFromConfigFile(CConfigFileMemory(text), "m");
    return ::testing::internal::GetCapturedStderr();
}

std::size_t linesOf(const std::string& said) {
    return static_cast<std::size_t>(std::count(said.begin(), said.end(), '\n'));
}

/// One line is said, and it holds all parts.
void expectLine(const std::string& text, const std::vector<std::string>& parts) {
    const std::string said = saidOf(text);
    EXPECT_EQ(linesOf(said), 1U) << text << said;
    for (const std::string& part : parts)
        EXPECT_NE(said.find(part), std::string::npos) << part << " in\n" << said;
}

/// What a section [s] of insertion options throws.
std::string errorOf(const std::string& lines) {
    CHGMMOccupancyMap::TInsertionOptions options;
    try {
        options.loadFromConfigFile(CConfigFileMemory("[s]\n" + lines + "\n"), "s");
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

TEST(OptionSlips, RightConfigurationsAreReadInSilence) {
    for (const std::string& text :
         {kOneMap, kOneMap + "[m_hgmmMap_00_insertOpts]\nlevels = 3\n",
          kOneMap + "logOutput_dir = x\n[m_hgmmMap_00_creationOpts]\nload_file =\n"
                    "[m_hgmmMap_00_renderOpts]\nlevel = 1\n",
          std::string("[m]\nhgmmMap_count = 2\n[m_hgmmMap_01_insertOpts]\nlevels = 3\n"),
          kOneMap + "[other]\nhgmmMap_count = 1\n[other_hgmmMap_00_insertOpts]\nlevels=3\n",
          kOneMap + "[n]\nlevels = 3\n[hgmmMapping]\nlevels = 3\n",
          std::string("[m]\nmrpt::maps::CHGMMOccupancyMap_count = 1\n"
                      "[m_mrpt::maps::CHGMMOccupancyMap_00_insertOpts]\nlevels = 3\n")})
        EXPECT_EQ(saidOf(text), "") << text;
}

TEST(OptionSlips, OptionsThatAreSavedAreReadInSilence) {
    CConfigFileMemory config(kOneMap);
    CHGMMOccupancyMap map;
    map.insertionOptions.saveToConfigFile(config, "m_hgmmMap_00_insertOpts");
    map.likelihoodOptions.saveToConfigFile(config, "m_hgmmMap_00_likelihoodOpts");
    map.renderOptions.saveToConfigFile(config, "m_hgmmMap_00_renderOpts");
    EXPECT_EQ(saidOf(config.getContent()), "");
}

TEST(OptionSlips, NumberOfAMapIsWrittenWithTwoDigits) {
    for (const std::string number : {"_0", "_000", "", "00", "_1"})
        expectLine(kOneMap + "[m_hgmmMap" + number + "_insertOpts]\nlevels = 3\n",
                   {"'m_hgmmMap" + number + "_insertOpts'",
                    "did you mean 'm_hgmmMap_00_insertOpts'"});
    expectLine("[m]\nhgmmMap_count = 2\n[m_hgmmMap_1_renderOpts]\nlevel = 1\n",
               {"did you mean 'm_hgmmMap_01_renderOpts'"});
}

TEST(OptionSlips, MapsThatAreNotCountedAreNamed) {
    expectLine(kOneMap + "[m_hgmmMap_01_insertOpts]\nlevels = 3\n",
               {"[m_hgmmMap_01_insertOpts]", "there is no map 01", "hgmmMap_count = 1"});
    expectLine("[m]\nhgmmMap_count = 2\n[m_hgmmMap_02_renderOpts]\nlevel = 1\n",
               {"there is no map 02", "hgmmMap_count = 2"});
}

TEST(OptionSlips, SectionsOfAParentWithoutCountAreNamed) {
    for (const std::string section :
         {"map_hgmmMap_00_insertOpts", "hgmmMap_00_insertOpts", "M2_hgmmmap_00_insertopts"})
        expectLine(kOneMap + "[" + section + "]\nlevels = 3\n",
                   {"[" + section + "]", "has hgmmMap_count",
                    "did you mean 'm_hgmmMap_00_insertOpts'"});
}

TEST(OptionSlips, UnknownEndsOfSectionsAreNamed) {
    expectLine(kOneMap + "[m_hgmmMap_00_insertionOpts]\nlevels = 3\n",
               {"'m_hgmmMap_00_insertionOpts'", "did you mean 'm_hgmmMap_00_insertOpts'"});
    expectLine(kOneMap + "[m_hgmmMap_00_x_renderOpts]\nlevel = 3\n",
               {"did you mean 'm_hgmmMap_00_renderOpts'"});
}

TEST(OptionSlips, OptionsBesideTheCountAreSentToTheirSection) {
    expectLine(kOneMap + "resolution_m = 4\n",
               {"'resolution_m' in section [m]", "[m_hgmmMap_00_insertOpts]"});
    expectLine(kOneMap + "softening_m = 4\n", {"[m_hgmmMap_00_likelihoodOpts]"});
    expectLine(kOneMap + "maxRange_m = 4\n",
               {"'maxRange_m' in section [m]",
                "[m_hgmmMap_00_insertOpts] or [m_hgmmMap_00_likelihoodOpts]"});
    expectLine(kOneMap + "load_file = 4\n", {"[m_hgmmMap_00_creationOpts]"});
    // Both maps' prefixes are asked, one answers.
    expectLine("[m]\nhgmmMap_count = 2\ncolour = 1\n", {"[m_hgmmMap_00_renderOpts]"});
}

TEST(OptionSlips, OptionsOfAnotherSectionAreSentThere) {
    const std::string prefix = kOneMap + "[m_hgmmMap_00_";
    for (const auto& option : hgmm::mrpt_bridge::listOptions()) {
        if (option.name == "minRange_m" || option.name == "maxRange_m") continue;
        for (const std::string section :
             {"insertOpts", "likelihoodOpts", "renderOpts", "creationOpts"})
            if (section != option.section)
                expectLine(prefix + section + "]\n" + option.name + " = 1\n",
                           {"'" + option.name + "'", "[m_hgmmMap_00_" + section + "]",
                            "belongs to section [m_hgmmMap_00_" + option.section + "]"});
    }
}

TEST(OptionSlips, KeysOfOtherCaseAreReadAndSaid) {
    const std::string text = "[m_hgmmMap_00_likelihoodOpts]\nmaxpoints = 3\n";
    expectLine(kOneMap + text, {"'maxpoints'", "is read as 'maxPoints'"});
    CHGMMOccupancyMap::TLikelihoodOptions options;
    options.loadFromConfigFile(CConfigFileMemory(text), "m_hgmmMap_00_likelihoodOpts");
    EXPECT_EQ(options.maxPoints, 3);
}

TEST(OptionSlips, PresentNameWinsOverAFormerOne) {
    const std::string text =
        "[m_hgmmMap_00_likelihoodOpts]\nsoftening_m = 3\nkernelWidth_m = 4\n";
    expectLine(kOneMap + text, {"'softening_m' is ignored", "'kernelWidth_m'"});
    CHGMMOccupancyMap::TLikelihoodOptions options;
    options.loadFromConfigFile(CConfigFileMemory(text), "m_hgmmMap_00_likelihoodOpts");
    EXPECT_EQ(options.kernelWidth_m, 4);
}

TEST(OptionSlips, OneMessageIsSaidOnceInAProcess) {
    const CConfigFileMemory config(kOneMap + "maxRange_m = 4\n[m_hgmmMap_0_insertOpts]\n");
    hgmm::mrpt_bridge::forgetWarnings();
    ::testing::internal::CaptureStderr();
    for (int k = 0; k < 3; ++k)
        TSetOfMetricMapInitializers().loadFromConfigFile(config, "m");
    EXPECT_EQ(linesOf(::testing::internal::GetCapturedStderr()), 2U);
}

TEST(OptionSlips, KeysThatAppearTwiceUnderOneHeadingAreNamed) {
    const std::string file = ::testing::TempDir() + "hgmm_repeated_keys.ini";
    const auto saidOfFile = [&](const std::string& text) {
        std::ofstream(file) << kOneMap << text;
        hgmm::mrpt_bridge::forgetWarnings();
        ::testing::internal::CaptureStderr();
        TSetOfMetricMapInitializers().loadFromConfigFileName(file, "m");
        return ::testing::internal::GetCapturedStderr();
    };
    const std::string section = "[m_hgmmMap_00_insertOpts]\n";
    EXPECT_EQ(saidOfFile(section + "levels = 2\n# a comment\nLevels= 3\n")
                  .find("[hgmm] warning: key 'Levels' appears twice in section "
                        "[m_hgmmMap_00_insertOpts]"),
              0U);
    EXPECT_EQ(saidOfFile(section + "levels = 2\n" + section + "levels = 3\n"), "")
        << "a section that appears again overrides";
    std::filesystem::remove(file);
}

TEST(OptionSlips, ErrorsNameTheKeyThatTheUserWrote) {
    EXPECT_EQ(errorOf("knownSigmas = 2"),
              "[s] knownSigmas = 2: must be in [2.4, 3.9], as extentSigmas is 2.4");
    EXPECT_EQ(errorOf("extentSigmas = 3.5"),
              "[s] extentSigmas = 3.5: must be in [1, 3], as knownSigmas is 3");
    EXPECT_EQ(errorOf("minRange_m = 400"),
              "[s] minRange_m = 400: must be in [0, 300], as maxRange_m is 300");
    EXPECT_EQ(errorOf("minRange_m = 4\nmaxRange_m = 3"),
              "[s] maxRange_m = 3: must be in [4, 100000], as minRange_m is 4");
    EXPECT_EQ(errorOf("leafAtOneMetre_m = 20"),
              "[s] leafAtOneMetre_m = 20: must be in [0.005, 10]");
    EXPECT_EQ(errorOf("contradictedKeep = x"),
              "[s] contradictedKeep = 'x': must be a number");
    EXPECT_EQ(errorOf("resolution_m = 20"),
              "[s] resolution_m = 20: must be in [0.005, 10]");
    EXPECT_EQ(errorOf("resolution_m = fine").rfind("[s] resolution_m = 'fine'", 0), 0U);
    // The leaf of modalities would be too small, and the file has no word of it.
    EXPECT_EQ(errorOf("resolution_m = 0.005"), "");
}

TEST(OptionSlips, ModelOfTheThesisIsRefusedWithTheStudyThatShowsIt) {
    const std::string said = errorOf("freeSpaceModel = 1");
    EXPECT_EQ(said.rfind("[s] freeSpaceModel = 1: ", 0), 0U) << said;
    EXPECT_NE(said.find("hgmm-replay --study free-space"), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
    for (const std::string zero : {"0", "0.0", "+0 ; ours", ""}) {
        EXPECT_EQ(errorOf("freeSpaceModel = " + zero), "") << zero;
        EXPECT_EQ(
            saidOf(kOneMap + "[m_hgmmMap_00_insertOpts]\nfreeSpaceModel = " + zero + "\n"),
            "");
    }
    EXPECT_NE(errorOf("freeSpaceModel = thesis"), "");
}

TEST(OptionSlips, ChannelsThatNoObservationHasAreNamed) {
    const std::string section = kOneMap + "[m_hgmmMap_00_insertOpts]\nmodalities = ";
    for (const auto& [name, meant] :
         {std::pair{"color", "rgb"}, std::pair{"Intensity", "intensity"},
          std::pair{"intensty", "intensity"}, std::pair{"reflectivity", "intensity"}})
        expectLine(
            section + name + "\n",
            {"'" + std::string(name) + "'", "r, g, b, intensity",
             "did you mean '" + std::string(meant) + "'?", "[m_hgmmMap_00_insertOpts]"});
    const std::string own = saidOf(section + "water content\n");
    EXPECT_NE(own.find("'water content'"), std::string::npos);
    EXPECT_EQ(own.find("did you mean"), std::string::npos) << own;
    for (const std::string known : {"RGB", "rgb, intensity", "r", ""})
        EXPECT_EQ(saidOf(section + known + "\n"), "") << known;
    EXPECT_EQ(paramsOf("modalities = RGB").modalities, (hgmm::Names{"r", "g", "b"}));
}

TEST(OptionSlips, ScansWithoutAnyModalityOfTheMapAreNamed) {
    hgmm::Scan scan;
    for (int i = 0; i < 100; ++i)
        scan.pushBack(2.F, 0.02F * static_cast<float>(i % 10),
                      0.02F * static_cast<float>(i / 10));
    for (const std::string name : {"r", "g"}) {
        auto& channel = scan.channels.emplace_back();
        channel.name = name;
        channel.values.assign(scan.size(), 0.5F);
    }
    const auto saidOn = [&](const hgmm::Names& modalities) {
        CHGMMOccupancyMap map;
        map.insertionOptions.params.modalities = modalities;
        hgmm::mrpt_bridge::forgetWarnings();
        ::testing::internal::CaptureStderr();
        for (int k = 0; k < 2; ++k) map.insertScan(scan);
        return ::testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(saidOn({"color"}),
              "[hgmm] warning: modalities: a scan has no channel color; it has r, g\n");
    EXPECT_EQ(saidOn({"r"}), "");
    EXPECT_EQ(saidOn({"intensity", "r"}), "");
    EXPECT_EQ(saidOn({}), "");
}

}  // namespace
