#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include "import_fixture.h"
#include "pcd_files.h"

using import_test::append;
using mrpt::maps::CColouredPointsMap;
using mrpt::maps::CPointsMapXYZI;
using mrpt::obs::CObservationPointCloud;

namespace {

/// Channels of point clouds: which are read, and what they are divided by.
class ImportChannels : public import_test::ImportTest {
 protected:
    void SetUp() override {
        import_test::ImportTest::SetUp();
        std::string lines;
        for (int i = 0; i < 4; ++i) lines += import_test::tumLine(i, {});
        write("poses.txt", lines);
    }
    /// Ascii, one point for each line of values behind 1 2 3.
    void writeScan(int number, const std::string& names, const std::string& sizes,
                   const std::string& types, const std::vector<std::string>& rows) const {
        std::string counts = "1 1 1", points;
        for (std::size_t i = 0; i < (sizes.size() + 1) / 2; ++i) counts += " 1";
        for (const auto& row : rows) points += "1 2 3 " + row + "\n";
        write("in/" + std::to_string(number) + ".pcd",
              import_test::pcdHeader("x y z " + names, "4 4 4 " + sizes, "F F F " + types,
                                     counts, rows.size(), "ascii") +
                  points);
    }
    import_test::Outcome importClouds(const std::string& options = "") const {
        return importIt("pcd in --poses poses.txt " + options);
    }
    /// The first point's intensity in each scan; -1 if it has none.
    std::vector<float> intensities() const {
        std::vector<float> result;
        for (const auto& o :
             import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"))) {
            const auto cloud = std::dynamic_pointer_cast<CPointsMapXYZI>(o->pointcloud);
            result.push_back(cloud ? cloud->getPointIntensity(0) : -1);
        }
        return result;
    }
    /// The first point's colour in the first scan.
    Eigen::Vector3f color() const {
        const auto log =
            import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
        const auto cloud = std::dynamic_pointer_cast<CColouredPointsMap>(
            log.empty() ? nullptr : log[0]->pointcloud);
        if (!cloud) return {-1, -1, -1};
        float x = 0, y = 0, z = 0, r = 0, g = 0, b = 0;
        cloud->getPointRGB(0, x, y, z, r, g, b);
        return {r, g, b};
    }
    static void expectSaid(const import_test::Outcome& result, const std::string& what) {
        EXPECT_NE(result.out.find(what), std::string::npos) << result.out;
    }
};

}  // namespace

TEST_F(ImportChannels, OneIntensityScaleServesTheWholeRecording) {
    // The scans alone would say 1, 255 and 65535.
    const auto writeLargest = [&](const std::string& largest) {
        writeScan(0, "intensity", "4", "F", {"0.5", "0.75"});
        writeScan(1, "intensity", "4", "F", {"51", "200"});
        writeScan(2, "intensity", "4", "F", {"51", largest});
    };
    writeLargest("204");
    expectSaid(importClouds(), "intensities divided by 255");
    for (const float value : {intensities()[1], intensities()[2]})
        EXPECT_FLOAT_EQ(value, 0.2F);
    EXPECT_FLOAT_EQ(intensities()[0], 0.5F / 255);
    writeLargest("900");
    expectSaid(importClouds(), "intensities divided by 65535");
    EXPECT_FLOAT_EQ(intensities()[1], 51.F / 65535);
    EXPECT_FLOAT_EQ(intensities()[2], 51.F / 65535);
    // The scan with the largest value need not be imported to count.
    importClouds("--step 3");
    EXPECT_FLOAT_EQ(intensities()[0], 0.5F / 65535);
    importClouds("--intensity-scale 102");
    EXPECT_FLOAT_EQ(intensities()[1], 0.5F);
    writeLargest("inf");
    importClouds();
    EXPECT_FLOAT_EQ(intensities()[1], 0.2F);
}

TEST_F(ImportChannels, DarkScansOfEightBitsKeepTheirScale) {
    writeScan(0, "intensity", "1", "U", {"1", "0"});
    importClouds();
    EXPECT_FLOAT_EQ(intensities()[0], 1.F / 255);
    writeScan(0, "intensity", "4", "F", {"1", "0"});
    importClouds();
    EXPECT_FLOAT_EQ(intensities()[0], 1);
}

TEST_F(ImportChannels, IntensityHasManyNames) {
    for (const char* name : {"intensity", "Intensity", "i", "reflectivity", "reflectance",
                             "scalar_Intensity"}) {
        SCOPED_TRACE(name);
        writeScan(0, name, "2", "U", {"102", "204"});
        expectSaid(importClouds(), std::string("fields used x y z ") + name);
        EXPECT_FLOAT_EQ(intensities()[0], 0.4F);
    }
    writeScan(0, "reflectivity ring intensity", "2 2 2", "U U U", {"7 3 102", "7 4 204"});
    expectSaid(importClouds(), "fields not used reflectivity ring");
    EXPECT_FLOAT_EQ(intensities()[0], 0.4F);
}

TEST_F(ImportChannels, ColoursHaveManyForms) {
    const auto expectColor = [&](const std::string& names, const std::string& sizes,
                                 const std::string& types, const std::string& values) {
        SCOPED_TRACE(names + " " + values);
        writeScan(0, names, sizes, types, {values, values});
        importClouds();
        EXPECT_LT((color() - Eigen::Vector3f(1, 128 / 255.F, 0)).norm(), 0.01);
    };
    expectColor("r g b", "1 1 1", "U U U", "255 128 0");
    expectColor("b g r", "4 4 4", "F F F", "0 128 255");
    expectColor("r g b", "4 4 4", "F F F", "1 0.50196 0");
    expectColor("red green blue", "2 2 2", "U U U", "65535 32896 0");
    expectColor("rgb", "4", "U", "16744448");
    expectColor("rgb", "4", "F", "2.3463969e-38");
    expectColor("rgb", "4", "F", "16744448");
    expectColor("rgba", "4", "I", "-32768");
    expectColor("rgba", "4", "U", "4294934528");
}

TEST_F(ImportChannels, ColourAndIntensityTogetherLeaveOneOutAndSayWhich) {
    writeScan(0, "rgb intensity", "4 4", "U F", {"16744448 51", "16744448 51"});
    expectSaid(importClouds(), "fields used x y z rgb; fields not used intensity");
    EXPECT_LT((color() - Eigen::Vector3f(1, 128 / 255.F, 0)).norm(), 0.01);
    expectSaid(importClouds("--channel intensity"),
               "fields used x y z intensity; fields not used rgb");
    EXPECT_FLOAT_EQ(intensities()[0], 0.2F);
}

TEST_F(ImportChannels, MillimetresAreDoubtedAndRead) {
    write("in/0.pcd", import_test::asciiPcd(2, "2000 0 1000\n2000 500 1000\n"));
    const auto refused = run("pcd in --poses poses.txt -o out.rawlog --poses-out out.tum");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_NE(refused.err.find("--units-per-metre"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(path("out.rawlog")));
    expectSaid(importClouds("--units-per-metre 1000"), "1000 units a metre");
    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    float x = 0, y = 0, z = 0;
    log.at(0)->pointcloud->getPointFast(0, x, y, z);
    EXPECT_EQ(x, 2);
    EXPECT_EQ(z, 1);
    importClouds("--units-per-metre 1");  // who says so is believed
}

TEST_F(ImportChannels, OneDamagedScanIsSkippedAndShiftsNothing) {
    for (int i = 0; i < 4; ++i)
        write("in/" + std::to_string(i) + ".pcd",
              import_test::asciiPcd(1, std::to_string(i) + " 2 3\n"));
    const std::string whole = import_test::readText(path("in/2.pcd"));
    for (const std::string& damaged : {std::string(), whole.substr(0, whole.size() - 4)}) {
        write("in/2.pcd", damaged);
        const auto result = importClouds();
        expectSaid(result, "imported 3 scans");
        expectSaid(result, "skipped 1 scans (1 unreadable, 0 without a pose)");
        EXPECT_NE(result.err.find("2.pcd: is "), std::string::npos) << result.err;
        const auto log =
            import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
        expectStampsMatch(log);
        EXPECT_EQ(poses()[2].stamp, 3);
        float x = 0, y = 0, z = 0;
        log[2]->pointcloud->getPointFast(0, x, y, z);
        EXPECT_EQ(x, 3);
    }
}
