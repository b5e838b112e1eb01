#include "import_fixture.h"
#include "pcd_files.h"

namespace {

class ImportCommandLine : public import_test::ImportTest {
 protected:
    void SetUp() override {
        import_test::ImportTest::SetUp();
        write("in/0.pcd", import_test::asciiPcd(1, "1 2 3\n"));
        write("in/1.pcd", import_test::asciiPcd(1, "1 2 3\n"));
        write("poses.txt", import_test::tumLine(0, {}) + import_test::tumLine(1, {}));
    }
    void expectBadInput(const std::string& arguments, const std::string& what) const {
        const auto result = run(arguments);
        EXPECT_EQ(result.exitCode, 1) << arguments;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
        EXPECT_TRUE(result.out.empty()) << result.out;
    }
};

}  // namespace

TEST_F(ImportCommandLine, HelpNamesAllOptions) {
    const auto general = run("--help");
    EXPECT_EQ(general.exitCode, 0);
    for (const char* format : {"tum", "7scenes", "kitti", "pcd", "ply", "simplemap"})
        EXPECT_NE(general.out.find(format), std::string::npos) << format;
    const auto pcd = run("pcd --help");
    EXPECT_EQ(pcd.exitCode, 0);
    for (const char* option :
         {"--poses", "--sensor-pose", "--world-frame", "--simplemap", "--cloud",
          "--actions", "--odometry-noise", "--seed", "--step", "--poses-out"})
        EXPECT_NE(pcd.out.find(option), std::string::npos) << option;
}

TEST_F(ImportCommandLine, WrongUsageIsTwo) {
    const std::string outputs = " -o out.rawlog --poses-out out.tum";
    for (const std::string& arguments :
         {std::string(),
          std::string("las in") + outputs,
          std::string("pcd in --poses poses.txt"),
          "pcd" + outputs,
          "pcd in" + outputs,
          "kitti in" + outputs,
          "pcd in --poses poses.txt --bogus" + outputs,
          "pcd in --poses poses.txt --world-frame" + outputs,
          "pcd in --world-frame --sensor-pose 0,0,0,0,0,0" + outputs,
          "pcd in --poses poses.txt --sensor-pose 0,0,0,0,0" + outputs,
          "pcd in --poses poses.txt --sensor-pose 0,0,0,0,0,nan" + outputs,
          "pcd in --poses poses.txt --step 0" + outputs,
          "pcd in --poses poses.txt --match name" + outputs,
          "pcd in --poses poses.txt --channel i" + outputs,
          "pcd in --poses poses.txt --units-per-metre 0" + outputs,
          "ply in" + outputs,
          "tum in --depth-scale -1" + outputs,
          "pcd in --poses poses.txt --step -3" + outputs,
          "pcd in --poses poses.txt --odometry-noise 0.1,1" + outputs,
          "pcd in --poses poses.txt --actions --odometry-noise -1,1" + outputs,
          "pcd in --poses poses.txt --actions --odometry-noise inf,1" + outputs,
          "7scenes in --intrinsics 0,1,1,1" + outputs,
          "7scenes in --intrinsics 1,1,x,1" + outputs}) {
        const auto result = run(arguments);
        EXPECT_EQ(result.exitCode, 2) << arguments;
        EXPECT_FALSE(result.err.empty()) << arguments;
    }
}

TEST_F(ImportCommandLine, TwoOutputsAreTwoFiles) {
    for (const char* outputs : {"-o same --poses-out same", "-o same --poses-out ./same",
                                "-o a --poses-out same --simplemap same"})
        expectBadInput("pcd in --poses poses.txt " + std::string(outputs),
                       "same: two outputs would be this file");
    EXPECT_FALSE(std::filesystem::exists(path("same")));
}

TEST_F(ImportCommandLine, BadInputIsOneAndNamed) {
    const std::string outputs = " -o out.rawlog --poses-out out.tum";
    std::filesystem::create_directories(path("empty"));
    for (const char* format : {"tum", "7scenes"})
        expectBadInput(std::string(format) + " nowhere" + outputs, "nowhere");
    expectBadInput("kitti nowhere --poses poses.txt" + outputs, "nowhere/velodyne");
    expectBadInput("pcd nowhere --poses poses.txt" + outputs, "nowhere: is no folder");
    expectBadInput("pcd empty --poses poses.txt" + outputs, "empty: holds no *.pcd files");
    expectBadInput("7scenes empty" + outputs, "empty: holds no *.depth.png files");
    expectBadInput("pcd in --poses nowhere.txt" + outputs, "nowhere.txt: cannot be read");
    expectBadInput("pcd in --poses in" + outputs, "in: cannot be read");
    write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 one\n");
    expectBadInput("pcd in --poses poses.txt" + outputs,
                   "poses.txt:2: 'one' is not a finite number");
}

TEST_F(ImportCommandLine, NumberlessNameAndBadTimesAreNamed) {
    const std::string outputs = " -o out.rawlog --poses-out out.tum";
    write("poses.txt", import_test::tumLine(1.6e28, {}) + import_test::tumLine(1.7e28, {}));
    expectBadInput("pcd in --poses poses.txt" + outputs, "stamps in seconds");
    write("in/last.pcd", import_test::asciiPcd(1, "1 2 3\n"));
    expectBadInput("pcd in --poses poses.txt" + outputs,
                   "last.pcd: the name holds no number");
}

TEST_F(ImportCommandLine, UnwritableOutputsLeaveNothingBehind) {
    expectBadInput("pcd in --poses poses.txt -o gone/out.rawlog --poses-out out.tum",
                   "gone/out.rawlog");
    expectBadInput("pcd in --poses poses.txt -o out.rawlog --poses-out gone/out.tum",
                   "gone/out.tum");
    expectBadInput(
        "pcd in --poses poses.txt -o out.rawlog --poses-out out.tum --simplemap "
        "gone/out.simplemap",
        "gone/out.simplemap");
    for (const auto& entry : std::filesystem::directory_iterator(path("")))
        EXPECT_NE(entry.path().filename().string().rfind("out.", 0), 0U) << entry;
}
