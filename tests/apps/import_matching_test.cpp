#include "import_fixture.h"
#include "pcd_files.h"

using mrpt::obs::CObservationPointCloud;

namespace {

/// Each scan has one point at (number, 0, 0), and the pose of scan n is at y = n: whoever
/// mixes them up shows.
class ImportMatching : public import_test::ImportTest {
 protected:
    using Numbers = std::vector<int>;

    static hgmm::Pose poseOf(int number) {
        return import_test::makePose(0, number, 0, 0.1 * number, 0, 0);
    }
    void writeScan(const std::string& name, int number) const {
        write("in/" + name + ".pcd",
              import_test::asciiPcd(1, std::to_string(number) + " 0 1\n"));
    }
    void writeScans(const Numbers& numbers, const char* format = "%06d") const {
        std::filesystem::remove_all(path("in"));
        for (const int number : numbers) writeScan(named(format, number), number);
    }
    static std::string named(const char* format, int number) {
        char name[60];
        std::snprintf(name, sizeof name, format, number);
        return name;
    }
    static std::string lines(const Numbers& numbers, double start, double step) {
        std::string text;
        for (const int number : numbers)
            text += import_test::tumLine(start + step * number, poseOf(number));
        return text;
    }
    static std::string kittiLines(const Numbers& numbers) {
        std::string text;
        for (const int number : numbers) text += import_test::kittiLine(poseOf(number));
        return text;
    }

    /// The import succeeds, and these scans have their own poses.
    import_test::Outcome expectScans(const Numbers& numbers,
                                     const std::string& options = "") const {
        const auto result = importIt("pcd in --poses poses.txt " + options);
        if (result.exitCode != 0) return result;
        const auto log =
            import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
        const auto trajectory = poses();
        Numbers found;
        for (std::size_t i = 0; i < log.size(); ++i) {
            float x = 0, y = 0, z = 0;
            log[i]->pointcloud->getPointFast(0, x, y, z);
            found.push_back(static_cast<int>(x));
            EXPECT_LT(import_test::poseDistance(trajectory[i].T_world_frame,
                                                poseOf(found.back())),
                      1e-5)
                << "scan " << found.back();
        }
        EXPECT_EQ(found, numbers);
        expectStampsMatch(log);
        return result;
    }
    void expectRefused(const std::string& what, const std::string& options = "") const {
        std::filesystem::remove(path("out.rawlog"));
        const auto result =
            run("pcd in --poses poses.txt -o out.rawlog --poses-out out.tum " + options);
        EXPECT_EQ(result.exitCode, 1) << result.out;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(path("out.rawlog")));
    }
};

constexpr double kScanEpoch = 1650000000;
const std::vector<int> kAllScans{0, 1, 2, 3, 4, 5};

}  // namespace

TEST_F(ImportMatching, NamesAreStampsInEachWayOfWritingThem) {
    // Six scans 50 ms apart, over a change of the second.
    const std::vector<std::vector<std::string>> writings{
        {"1650000000.850000", "1650000000.900000", "1650000000.950000", "1650000001.000000",
         "1650000001.050000", "1650000001.100000"},
        {"scan_1650000000_850000000", "scan_1650000000_900000000",
         "scan_1650000000_950000000", "scan_1650000001_000000000",
         "scan_1650000001_050000000", "scan_1650000001_100000000"},
        {"1650000000-850000000", "1650000000-900000000", "1650000000-950000000",
         "1650000001-0", "1650000001-50000000", "1650000001-100000000"},
        {"1650000000.85", "1650000000.9", "1650000000.95", "1650000001.0", "1650000001.05",
         "1650000001.1"},
        {"1650000000850000000", "1650000000900000000", "1650000000950000000",
         "1650000001000000000", "1650000001050000000", "1650000001100000000"},
        {"1650000000850000", "1650000000900000", "1650000000950000", "1650000001000000",
         "1650000001050000", "1650000001100000"},
        {"1650000000850", "1650000000900", "1650000000950", "1650000001000",
         "1650000001050", "1650000001100"},
        {"frame_20220415T052000.850000", "frame_20220415T052000.900000",
         "frame_20220415T052000.950000", "frame_20220415T052001.000000",
         "frame_20220415T052001.050000", "frame_20220415T052001.100000"},
        {"2022-04-15-05-20-00-850000", "2022-04-15-05-20-00-900000",
         "2022-04-15-05-20-00-950000", "2022-04-15-05-20-01-000000",
         "2022-04-15-05-20-01-050000", "2022-04-15-05-20-01-100000"},
        {"000007_1650000000.850000", "000008_1650000000.900000", "000009_1650000000.950000",
         "000010_1650000001.000000", "000011_1650000001.050000",
         "000012_1650000001.100000"}};
    write("poses.txt", lines(kAllScans, kScanEpoch + 0.85, 0.05));
    for (const auto& names : writings) {
        SCOPED_TRACE(names[0]);
        std::filesystem::remove_all(path("in"));
        for (std::size_t i = 0; i < names.size(); ++i)
            writeScan(names[i], static_cast<int>(i));
        const auto result = expectScans(kAllScans);
        EXPECT_NE(result.out.find("order by stamp"), std::string::npos) << result.out;
        // A lost scan takes its pose along, a lost pose its scan.
        std::filesystem::remove(path("in/" + names[2] + ".pcd"));
        expectScans({0, 1, 3, 4, 5});
    }
}

TEST_F(ImportMatching, StampsOfPosesMayBeInNanosecondsOrSecondsAndNanoseconds) {
    writeScans({});
    for (const int i : kAllScans)
        writeScan("1650000000." + std::to_string(100000 + 50000 * i), i);
    std::string nanoseconds, split, counted;
    for (const int i : kAllScans) {
        const std::string pose = import_test::tumLine(0, poseOf(i)).substr(2);
        const std::string part = std::to_string(100000000 + 50000000 * i);
        nanoseconds += "1650000000" + part + " " + pose;
        split += "1650000000," + part + "," + pose;
        counted += std::to_string(i + 7) + ", 1650000000, " + part + ", " + pose;
    }
    for (const auto& text : {nanoseconds, split, counted}) {
        write("poses.txt", text);
        expectScans(kAllScans);
        EXPECT_NEAR(poses()[1].stamp, kScanEpoch + 0.15, 1e-5);
    }
}

TEST_F(ImportMatching, ScansWithoutAPoseAreSkippedAndCounted) {
    writeScans({});
    for (const int i : kAllScans)
        writeScan("1650000000." + std::to_string(100000 + 50000 * i), i);
    write("poses.txt", lines({0, 1, 3, 5}, kScanEpoch + 0.1, 0.05));
    const auto result = expectScans({0, 1, 3, 5});
    EXPECT_NE(result.out.find("skipped 2 scans (0 unreadable, 2 without a pose)"),
              std::string::npos)
        << result.out;
}

TEST_F(ImportMatching, ToleranceIsStatedAndHolds) {
    writeScans({});
    for (const int i : kAllScans)
        writeScan("1650000000." + std::to_string(100000 + 100000 * i), i);
    write("poses.txt", lines(kAllScans, kScanEpoch + 0.13, 0.1));
    expectRefused("within 0.02");
    const auto result = importIt("pcd in --poses poses.txt --tolerance 0.04");
    EXPECT_NE(result.out.find("within 0.04 s"), std::string::npos) << result.out;
    // Between two poses the pose is interpolated.
    EXPECT_NEAR(poses()[1].T_world_frame.t.y(), 0.7, 1e-4);
}

TEST_F(ImportMatching, OtherClocksAreRefused) {
    writeScans({});
    for (const int i : kAllScans)
        writeScan("1650000000." + std::to_string(100000 + 50000 * i), i);
    write("poses.txt", lines(kAllScans, 12.1, 0.05));
    expectRefused("do not tell which pose");
    write("poses.txt", kittiLines(kAllScans));
    expectRefused("do not tell which pose");
    expectScans(kAllScans, "--match order");
}

TEST_F(ImportMatching, NumbersCountLinesAndGapsShiftNothing) {
    write("poses.txt", lines(kAllScans, 0, 0.1));
    writeScans(kAllScans);
    expectScans(kAllScans);
    writeScans({0, 1, 3, 5});
    expectScans({0, 1, 3, 5});
    write("poses.txt", kittiLines(kAllScans));
    expectScans({0, 1, 3, 5});
    EXPECT_NEAR(poses()[2].stamp, 0.3, 1e-6);
    // From 1 on: only so is there a line for the last one.
    write("poses.txt", kittiLines({1, 2, 3, 4, 5, 6}));
    writeScans({1, 3, 6}, "cloud_%d_v2");
    expectScans({1, 3, 6});
    // Neither 0 nor 1, but without gaps and as many as the lines.
    write("poses.txt", kittiLines({7, 8, 9, 10}));
    writeScans({7, 8, 9, 10}, "%d");
    expectScans({7, 8, 9, 10});
}

TEST_F(ImportMatching, TheFirstNumberIsAskedForIfItIsInDoubt) {
    write("poses.txt", kittiLines(kAllScans));
    writeScans({1, 3, 4});
    expectRefused("--first-number");
    expectScans({1, 3, 4}, "--first-number 0");
    write("poses.txt", kittiLines({1, 2, 3, 4, 5, 6}));
    expectScans({1, 3, 4}, "--first-number 1");
    expectRefused("before number 2", "--first-number 2");
}

TEST_F(ImportMatching, FewerLinesThanNumbersAreRefused) {
    writeScans({0, 1, 2, 3});
    write("poses.txt", lines({0, 1, 3}, kScanEpoch, 0.1));
    expectRefused("only 3 poses for the 4 .pcd files");
    write("poses.txt", kittiLines({0, 1, 3}));
    expectRefused("only 3 poses for the 4 .pcd files");
    // Poses of a higher rate are not those of the first scans.
    write("poses.txt", lines({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, kScanEpoch, 0.02));
    expectRefused("--match number");
}

TEST_F(ImportMatching, PosesWithNumbersAreMatchedByThem) {
    const std::vector<int> posed{0, 2, 3, 5, 6};
    std::string tum, places, kitti, g2o, symbols;
    for (const int i : posed) {
        const std::string number = std::to_string(i) + " ";
        const std::string pose = import_test::tumLine(0, poseOf(i)).substr(2);
        tum += number + pose;
        kitti += number + import_test::kittiLine(poseOf(i));
        g2o += "VERTEX_SE3:QUAT " + number + pose;
        symbols += "VERTEX_SE3:QUAT " + std::to_string((std::uint64_t{'x'} << 56) + i) +
                   " " + pose;
    }
    g2o += "FIX 0\nEDGE_SE3:QUAT 0 2 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1\n";
    writeScans({0, 1, 2, 3, 5, 6});
    for (const auto& text : {tum, kitti, g2o, symbols}) {
        write("poses.txt", text);
        const auto result = expectScans(posed);
        EXPECT_NE(result.out.find("1 without a pose"), std::string::npos) << result.out;
    }
    // In any order.
    write("poses.txt",
          "VERTEX_SE2 3 0 3 0.3\nVERTEX_SE2 1 0 1 0.1\nVERTEX_SE2 2 0 2 0.2\n");
    expectScans({1, 2, 3});
    write("poses.txt",
          "VERTEX2 1 0 1 0.1\nVERTEX2 2 0 2 0.2\nVERTEX2 3 0 3 0.3\nEDGE2 1 2 0 1 0.1 1 0 "
          "1 1 0 0\n");
    expectScans({1, 2, 3});
}

TEST_F(ImportMatching, NumbersAloneGiveNoRotation) {
    writeScans({2, 4, 5});
    write("poses.txt", "# number x y z\n2 0 2 1\n3 0 3 1\n4 0 4 1\n5 0 5 1\n");
    const auto result = importIt("pcd in --poses poses.txt");
    ASSERT_EQ(poses().size(), 3U);
    EXPECT_EQ(poses()[1].T_world_frame.t, Eigen::Vector3d(0, 4, 1));
    EXPECT_TRUE(poses()[1].T_world_frame.R.isIdentity(1e-12));
}

TEST_F(ImportMatching, DifferentStartsAreRefused) {
    writeScans({1, 2, 3, 4, 5, 6});
    std::string g2o;
    for (const int i : kAllScans)
        g2o += "VERTEX_SE3:QUAT " + std::to_string(i) + " " +
               import_test::tumLine(0, poseOf(i)).substr(2);
    for (const auto& text : {g2o, lines(kAllScans, 0, 1)}) {
        write("poses.txt", text);
        expectRefused("different starts");
        expectScans({1, 2, 3, 4, 5}, "--match number");
    }
}

TEST_F(ImportMatching, NamesThatOrderInTwoWaysAndDoublesAreRefused) {
    write("poses.txt", kittiLines({0, 1, 2}));
    writeScans({});
    writeScan("a0_5", 0);
    writeScan("a0_6", 1);
    writeScan("a1_0", 2);
    expectRefused("several numbers");
    writeScans({0, 1});
    writeScan("1", 1);
    expectRefused("same number twice");
    writeScans({0, 1});
    write("poses.txt", import_test::tumLine(0, poseOf(0)) +
                           import_test::tumLine(1, poseOf(1)) +
                           import_test::tumLine(1, poseOf(2)));
    expectRefused("two different poses");
}

TEST_F(ImportMatching, BadPoseFilesAreNamed) {
    writeScans({0, 1});
    write("poses.txt", "0 1 2 3 4\n");
    expectRefused("poses.txt:1: expected 8 numbers");
    write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0\n");
    expectRefused("poses.txt:2: expected 8 numbers as in the lines before");
    write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 0\n");
    expectRefused("poses.txt:2: the quaternion is null");
    write("poses.txt", "0 1 2 3 0.1 0.2 0.3\n");
    expectRefused("no unit quaternion");
    write("poses.txt", "VERTEX_SE2 0 1 2\n");
    expectRefused("poses.txt:1: VERTEX_SE2 needs 3 numbers");
    write("poses.txt", "#t x y z q_w q_x q_y q_z\n0 0 0 0 1 0 0 0\n");
    expectRefused("poses.txt:1: says that qw comes before qx");
    write("poses.txt", "VERTEX_XY 0 1 2\n");
    expectRefused("holds no poses");
    write("poses.txt", import_test::tumLine(5.1, {}) + import_test::tumLine(4.1, {}));
    expectRefused("go back");
}
