#include <gtest/gtest.h>

#include <iostream>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "lidar_walk.h"
#include "stock_app.h"

namespace fs = std::filesystem;

namespace {

/// The shipped configuration, with the names of its log and map filled in, and the values
/// of some keys replaced.
void copyConfig(const fs::path& folder,
                const std::vector<std::pair<std::string, std::string>>& values = {}) {
    std::ifstream in(fs::path(HGMM_CONFIG_FILES) / "pf-localization-3d.ini");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    for (const auto& [placeholder, name] : {std::pair{"= mylog.rawlog", "= log.rawlog"},
                                            std::pair{"= mymap.hgmm", "= map.hgmm"}}) {
        ASSERT_NE(text.find(placeholder), std::string::npos);
        text = std::regex_replace(text, std::regex(placeholder), name);
    }
    for (const auto& [key, value] : values) {
        const std::regex line("\n" + key + " *=[^\n]*");
        ASSERT_TRUE(std::regex_search(text, line)) << key;
        text = std::regex_replace(text, line, "\n" + key + " = " + value);
    }
    std::ofstream(folder / "config.ini") << text;
}

/// A folder with the map and the log, until the end of the test.
class StockLocalization3d : public ::testing::Test {
 protected:
    StockLocalization3d() {
        fs::create_directories(folder_);
        lidar_walk::saveMap((folder_ / "map.hgmm").string());
        lidar_walk::saveLog((folder_ / "log.rawlog").string());
    }
    ~StockLocalization3d() override { fs::remove_all(folder_); }

    /// Whether one of three runs ends near the truth: the program seeds itself from the
    /// clock, so a run may fail by chance.
    bool endsWithin(double limit_m, double limit_deg) const {
        for (int run = 0; run < 3; ++run) {
            const auto result = stock_app::run("pf-localization config.ini", folder_);
            EXPECT_EQ(result.exitCode, 0) << result.output.substr(0, 4000);
            const auto [metres, degrees] = lidar_walk::finalError(result.output);
            std::cout << "run " << run << ": " << metres << " m, " << degrees << " deg\n";
            if (metres < limit_m && degrees < limit_deg) return true;
        }
        return false;
    }

    const fs::path folder_ = fs::path(::testing::TempDir()) /
                             ("hgmm-localization-3d-" + std::to_string(::getpid()));
};

// The start is spread over 4 m and 20 deg in all six dimensions; the first pose is 1.6 m
// and 7 deg from the middle of that.
TEST_F(StockLocalization3d, EndsAtTheTruePoseInASavedMap) {
    copyConfig(folder_);
    EXPECT_TRUE(endsWithin(0.2, 2));
}

// Few particles, for sanitized builds as well. The start is spread over 1 m in x and y, and
// the truth stands in its corner: without the map, the end would be .6 m off.
TEST_F(StockLocalization3d, FewParticlesLeaveAStartThatIsOff) {
    copyConfig(folder_, {{"particles_count", "80"},
                         {"sampleSize", "80"},
                         {"init_PDF_min_x", "-1.1"},
                         {"init_PDF_max_x", "-0.1"},
                         {"init_PDF_min_y", "-0.9"},
                         {"init_PDF_max_y", "0.1"},
                         {"init_PDF_min_z", "0.9"},
                         {"init_PDF_max_z", "1.1"},
                         {"init_PDF_min_yaw_deg", "4"},
                         {"init_PDF_max_yaw_deg", "8"},
                         {"init_PDF_min_pitch_deg", "-2"},
                         {"init_PDF_max_pitch_deg", "2"},
                         {"init_PDF_min_roll_deg", "1"},
                         {"init_PDF_max_roll_deg", "5"}});
    EXPECT_TRUE(endsWithin(0.25, 5));
}

}  // namespace
