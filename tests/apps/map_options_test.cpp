#include <algorithm>
#include <sstream>

#include "replay_map_fixture.h"

namespace {

/// Names of options in a listing: the first words of lines with a default.
std::vector<std::string> namesIn(const std::string& listing) {
    std::vector<std::string> names;
    std::istringstream lines(listing);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name, equals;
        if (words >> name >> equals && equals == "=") names.push_back(name);
    }
    return names;
}

class MapOptions : public ReplayFolder {};

}  // namespace

TEST_F(MapOptions, ListsTheBasicOnes) {
    const Outcome outcome = mapTool("options");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto names = namesIn(outcome.out);
    EXPECT_LE(names.size(), 8U);
    for (const char* wanted : {"resolution_m", "modalities", "kernelWidth_m", "load_file"})
        EXPECT_EQ(std::count(names.begin(), names.end(), wanted), 1) << wanted;
    expectHas(outcome.out, "= 0.04");
    expectHas(outcome.out, "0.005 to 10 m");
    expectHas(outcome.out, "hgmmMap_00_likelihoodOpts");
}

TEST_F(MapOptions, ListsAllBySection) {
    const Outcome outcome = mapTool("options --all");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(namesIn(outcome.out).size(), 62U);
    std::size_t at = 0;
    for (const char* next :
         {"_insertOpts]", "extentSigmas", "_likelihoodOpts]", "outlierRatio",
          "_renderOpts]", "drawVoxels", "_creationOpts]", "load_file"}) {
        at = outcome.out.find(next, at);
        ASSERT_NE(at, std::string::npos) << next;
    }
    EXPECT_EQ(mapTool("options --all --markdown").exitCode, 2);
}
