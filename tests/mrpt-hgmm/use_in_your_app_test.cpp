#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <regex>

#include "lidar_walk.h"
#include "observations.h"
#include "stock_app.h"

namespace fs = std::filesystem;

namespace {

std::string contentOf(const fs::path& file) {
    std::ifstream in(file);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Configurations made as docs/use-in-your-app.md says: one of MRPT's, then lines of the
/// page.
class UseInYourApp : public ::testing::Test {
 protected:
    UseInYourApp()
        : folder(fs::path(::testing::TempDir()) /
                 ("hgmm-use-" + std::to_string(::getpid()) +
                  ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
        fs::create_directories(folder);
    }
    ~UseInYourApp() override { fs::remove_all(folder); }

    static std::string shipped(const std::string& name) {
        return contentOf("/usr/share/mrpt/config_files/" + name);
    }

    /// The `number`th ini block below a heading of the page.
    static std::string linesOf(const std::string& heading, int number = 0) {
        const std::string page = contentOf(HGMM_USE_IN_YOUR_APP);
        auto at = page.find("\n## " + heading + "\n");
        if (at == std::string::npos) {
            ADD_FAILURE() << "no heading '" << heading << "'";
            return {};
        }
        const auto end = page.find("\n## ", at + 1);
        const std::string open = "```ini\n";
        for (int i = 0; i <= number; ++i) at = page.find(open, at + 1);
        if (at >= end) {
            ADD_FAILURE() << "no ini block " << number << " below '" << heading << "'";
            return {};
        }
        const auto begin = at + open.size();
        return "\n" + page.substr(begin, page.find("```", begin) - begin) + "\n";
    }

    void write(const std::string& text) const { std::ofstream(folder / "my.ini") << text; }

    std::string run(const std::string& command) const {
        const auto result = stock_app::run(command, folder);
        EXPECT_EQ(result.exitCode, 0) << result.output.substr(0, 4000);
        EXPECT_EQ(result.output.find("unknown key"), std::string::npos);
        return result.output;
    }

    /// Of the only map that was saved.
    std::size_t savedComponents() const {
        std::size_t components = 0, maps = 0;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.path().extension() != ".hgmm") continue;
            mrpt::maps::CHGMMOccupancyMap map;
            map.loadFromFile(entry.path().string());
            components = map.model().mixture().size();
            ++maps;
        }
        EXPECT_EQ(maps, 1U);
        return components;
    }

    const fs::path folder;
};

const std::string kDatasets = observations::datasets();
/// Paths of the data, and no windows.
const std::string kLocalizationHere =
    "\n[LocalizationExperiment]\nrawlog_file = " + kDatasets +
    "localization_demo.rawlog\nmap_file = " + kDatasets +
    "localization_demo.simplemap.gz\n3DSceneFrequency = -1\n"
    "SHOW_PROGRESS_3D_REAL_TIME = false\n";
const std::string kMappingHere =
    "\n[MappingApplication]\nrawlog_file = " + kDatasets +
    "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog\n"
    "SAVE_3D_SCENE = 0\nSHOW_PROGRESS_3D_REAL_TIME = 0\nSHOW_PROGRESS_IN_WINDOW = 0\n"
    "SAVE_MAP_IMAGES = 0\nLOG_FREQUENCY = 1000\n";
const std::string kObservationsToMap =
    "observations2map my.ini '" + kDatasets + "localization_demo.simplemap.gz' out";

#ifdef HGMM_ASAN_RUNTIME
/// Sanitized, few particles must do.
const std::string kFewer =
    "\n[LocalizationExperiment]\nparticles_count = 500\n[KLD_options]\n"
    "KLD_minSampleSize = 100\nKLD_maxSampleSize = 500\n[PF_options]\nsampleSize = 50\n"
    "[MappingApplication]\nsampleSize = 4\n";
#else
const std::string kFewer;
#endif

TEST_F(UseInYourApp, Localization2d) {
    write(shipped("pf-localization/localization_demo.ini") +
          linesOf("pf-localization, 2D") + kLocalizationHere + kFewer);
    bool good = false;
    // Seeded by the clock, a run may fail by chance.
    for (int k = 0; k < 3 && !good; ++k) {
        const std::string output = run("pf-localization my.ini");
        const auto at = output.rfind("PDF estimation: (");
        ASSERT_NE(at, std::string::npos);
        double x = 0, y = 0;
        ASSERT_EQ(std::sscanf(output.c_str() + at, "PDF estimation: (%lf,%lf", &x, &y), 2);
        std::cout << "run " << k << ": " << x << ", " << y << "\n";
        good = !kFewer.empty() || std::hypot(x - 15.89, y + 10.0) < 0.3;
    }
    EXPECT_TRUE(good);
}

TEST_F(UseInYourApp, Localization2dInASavedMap) {
    write(linesOf("observations2map"));
    run(kObservationsToMap);
    EXPECT_GT(savedComponents(), 50U);
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".hgmm")
            fs::rename(entry.path(), folder / "mymap.hgmm");
    write(shipped("pf-localization/localization_demo.ini") +
          linesOf("pf-localization, 2D") + kLocalizationHere +
          linesOf("pf-localization, 2D", 1) +
          "\n[LocalizationExperiment]\nparticles_count = 500\n[KLD_options]\n"
          "KLD_minSampleSize = 100\nKLD_maxSampleSize = 500\n");
    EXPECT_NE(run("pf-localization my.ini").find("PDF estimation"), std::string::npos);
}

TEST_F(UseInYourApp, Localization3d) {
    lidar_walk::saveMap((folder / "mymap.hgmm").string());
    lidar_walk::saveLog((folder / "mylog.rawlog").string());
    write(shipped("pf-localization/localization_demo.ini") +
          "\n[LocalizationExperiment]\n3DSceneFrequency = -1\n"
          "SHOW_PROGRESS_3D_REAL_TIME = false\n" +
          linesOf("How do I localise a 3D lidar in a saved 3D map with pf-localization?") +
          kFewer);
    bool good = false;
    for (int k = 0; k < 3 && !good; ++k) {
        const auto [metres, degrees] =
            lidar_walk::finalError(run("pf-localization my.ini"));
        std::cout << "run " << k << ": " << metres << " m, " << degrees << " deg\n";
        ASSERT_TRUE(std::isfinite(metres));
        good = !kFewer.empty() || (metres < 0.2 && degrees < 2);
    }
    EXPECT_TRUE(good);
}

TEST_F(UseInYourApp, RbpfSlam) {
    write(shipped("rbpf-slam/gridmapping_optimal_sampling.ini") + linesOf("rbpf-slam") +
          "\n[MappingApplication]\nsampleSize = 4\nverbosity_level = INFO\n" +
          kMappingHere);
    run("rbpf-slam my.ini");
    EXPECT_GT(savedComponents(), 100U);
}

TEST_F(UseInYourApp, IcpSlam) {
    write(shipped("icp-slam/icp-slam_demo_classic.ini") + linesOf("icp-slam") +
          kMappingHere);
    run("icp-slam my.ini");
    EXPECT_GT(savedComponents(), 100U);
}

}  // namespace
