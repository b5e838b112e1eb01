#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "pcd_files.h"
#include "replay_map_fixture.h"

namespace fs = std::filesystem;

namespace {

/// What the programs do to files that are in the place of their outputs.
class Outputs : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        room_ = recordRoom(3, 400);
        ASSERT_EQ(replay(room_ + " --save-map " + path("m.hgmm")).exitCode, 0);
        fs::copy_file(path("m.hgmm"), path("o.hgmm"));
        put("c.ini", "# options\n[map]\nhgmmMap_count = 1\n");
        fs::create_directories(path("in"));
        put("in/1.pcd", import_test::asciiPcd(2, "1 2 3\n4 5 6\n"));
        put("poses.txt", "1 0 0 0 0 0 0 1\n");
        pcd_ = "pcd " + path("in") + " --poses " + path("poses.txt");
    }
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }
    void link(const std::string& to, const std::string& name) const {
        fs::create_symlink(path(to), path(name));
    }
    /// The run ends with code 1 and one line of what is wrong, and the file is what it was.
    void expectRefused(const std::string& program, const std::string& arguments,
                       const std::string& file, const std::string& what) const {
        const std::string before = content(file);
        const Outcome outcome = run(program, arguments);
        EXPECT_EQ(outcome.exitCode, 1) << arguments;
        expectHas(outcome.err, what);
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1)
            << outcome.err;
        EXPECT_EQ(outcome.out, "") << "it had begun to work: " << arguments;
        EXPECT_TRUE(content(file) == before) << arguments;
    }
    void expectNoLeftovers() const {
        for (const auto& entry : fs::directory_iterator(path("")))
            EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry;
    }

    std::string room_, pcd_;
};

/// A file system of its own, where root may mount one.
class Mounted {
 public:
    Mounted(const std::string& folder, unsigned long flags, const char* options)
        : folder_(folder) {
        fs::create_directories(folder);
        isMounted_ = ::mount("hgmm-test", folder.c_str(), "tmpfs", flags, options) == 0;
    }
    ~Mounted() {
        if (isMounted_) ::umount(folder_.c_str());
    }
    Mounted(const Mounted&) = delete;
    Mounted& operator=(const Mounted&) = delete;
    bool isMounted() const { return isMounted_; }

 private:
    std::string folder_;
    bool isMounted_ = false;
};

}  // namespace

TEST_F(Outputs, ReplayReplacesNoInput) {
    const std::string input = "is an input of this run";
    const std::string map = room_ + " --config " + path("c.ini") + " --save-map ";
    link("room.rawlog", "soft");
    fs::create_hard_link(path("room.rawlog"), path("hard"));
    for (const char* name : {"room.rawlog", "soft", "hard", "room.tum", "c.ini"})
        for (const char* force : {"", " --force"})
            expectRefused("hgmm-replay", map + path(name) + force, name, input);
    fs::create_directories(path("report"));
    link("room.tum", "report/metrics.json");
    expectRefused("hgmm-replay", room_ + " --report " + path("report"), "room.tum", input);
}

TEST_F(Outputs, MapCommandsReplaceNoInput) {
    const std::string input = "is an input of this run";
    const std::string m = path("m.hgmm"), o = path("o.hgmm");
    link("m.hgmm", "link.hgmm");
    for (const std::string& to : {m, path("link.hgmm")}) {
        expectRefused("hgmm-map", "sample " + m + " -n 9 -o " + to, "m.hgmm", input);
        expectRefused("hgmm-map", "forget --box=0,0,0,1,1,1 " + m + " " + to, "m.hgmm",
                      input);
        expectRefused("hgmm-map", "merge " + m + " " + o + " --force -o " + to, "m.hgmm",
                      input);
        expectRefused("hgmm-map", "merge " + o + " " + m + " -o " + to, "m.hgmm", input);
        expectRefused("hgmm-map", "view " + m + " --force -o " + to, "m.hgmm", input);
        for (const char* format : {"ply", "3Dscene", "png", "bt", "ot", "yaml --height 0"})
            expectRefused("hgmm-map",
                          "export " + m + " " + to + " --force --format " + format,
                          "m.hgmm", input);
    }
    link("m.hgmm", "s.pgm");
    expectRefused("hgmm-map", "export " + m + " " + path("s.yaml") + " --height 0",
                  "m.hgmm", input);
    link("m.hgmm", "t.offset.txt");
    expectRefused("hgmm-map", "export " + m + " " + path("t.bt") + " --local", "m.hgmm",
                  input);
}

TEST_F(Outputs, ImportsReplaceNoInput) {
    const std::string input = "is an input of this run";
    const std::string log = path("room.rawlog"), poses = path("room.tum");
    const std::string from = "rawlog " + log + " --poses " + poses;
    const auto toPoses = [&](const std::string& name) {
        return " -o " + path("out.rawlog") + " --poses-out " + path(name);
    };
    expectRefused("hgmm-import", from + " -o " + log + " --poses-out " + path("out.tum"),
                  "room.rawlog", input);
    for (const char* name : {"room.rawlog", "room.tum"})
        expectRefused("hgmm-import", from + toPoses(name) + " --force", name, input);
    for (const char* option : {" --simplemap ", " --cloud "})
        expectRefused("hgmm-import", from + toPoses("out.tum") + option + log + " --force",
                      "room.rawlog", input);
    for (const char* name : {"poses.txt", "in/1.pcd"})
        expectRefused("hgmm-import", pcd_ + toPoses(name) + " --force", name, input);
    EXPECT_FALSE(fs::exists(path("out.rawlog")));
    expectNoLeftovers();
}

TEST_F(Outputs, OtherKindsAreReplacedOnlyIfAskedFor) {
    const std::string m = path("m.hgmm");
    const std::vector<std::pair<std::string, std::string>> commands{
        {"hgmm-replay", room_ + " --save-map "},
        {"hgmm-map", "sample " + m + " -n 9 -o "},
        {"hgmm-map", "forget --box=0,0,0,1,1,1 " + m + " "},
        {"hgmm-map", "merge " + m + " " + path("o.hgmm") + " -o "},
        {"hgmm-map", "export --format 3Dscene " + m + " "},
        {"hgmm-map", "export --format bt " + m + " "},
        {"hgmm-import", pcd_ + " --poses-out " + path("p.tum") + " -o "},
        {"hgmm-import", pcd_ + " -o " + path("p.rawlog") + " --poses-out "}};
    for (const auto& [program, arguments] : commands) {
        put("notes", "Dear diary,\n");
        expectRefused(program, arguments + path("notes"), "notes", "notes: is a text, and");
        std::string withForce = arguments + path("notes");
        withForce.insert(withForce.find(' '), " --force");
        const Outcome forced = run(program, withForce);
        EXPECT_EQ(forced.exitCode, 0) << forced.err;
        EXPECT_EQ(content("notes").find("diary"), std::string::npos) << arguments;
        const Outcome again = run(program, arguments + path("notes"));
        EXPECT_EQ(again.exitCode, 0) << "its own kind: " << again.err;
    }
    fs::create_directories(path("report"));
    put("report/metrics.json", "Dear diary,\n");
    expectRefused("hgmm-replay", room_ + " --report " + path("report"),
                  "report/metrics.json", "is a text");
    expectNoLeftovers();
}

TEST_F(Outputs, LinksStayAndTheirTargetsAreWritten) {
    fs::create_directories(path("disk"));
    link("disk/new.hgmm", "link.hgmm");
    ASSERT_EQ(replay(room_ + " --save-map " + path("link.hgmm")).exitCode, 0);
    EXPECT_TRUE(fs::is_symlink(path("link.hgmm")));
    EXPECT_TRUE(content("disk/new.hgmm") == content("m.hgmm"));
    link("disk/out.rawlog", "out.rawlog");
    ASSERT_EQ(
        run("hgmm-import", pcd_ + " -o " + path("out.rawlog") + " --poses-out /dev/null")
            .exitCode,
        0);
    EXPECT_TRUE(fs::is_symlink(path("out.rawlog")));
    EXPECT_TRUE(fs::is_regular_file(path("disk/out.rawlog")));
}

TEST_F(Outputs, DevicesAreWrittenDirectly) {
    const std::string m = path("m.hgmm");
    const std::vector<std::pair<std::string, std::string>> commands{
        {"hgmm-replay", room_ + " --quiet --save-map "},
        {"hgmm-map", "sample " + m + " -n 9 -o "},
        {"hgmm-map", "forget --box=0,0,0,1,1,1 " + m + " "},
        {"hgmm-map", "export --format 3Dscene " + m + " "},
        {"hgmm-import", pcd_ + " --poses-out " + path("p.tum") + " -o "},
        {"hgmm-import", pcd_ + " -o " + path("p.rawlog") + " --poses-out "}};
    for (const auto& [program, arguments] : commands) {
        const Outcome null = run(program, arguments + "/dev/null");
        EXPECT_EQ(null.exitCode, 0) << null.err;
        for (const char* name : {"p.tum", "p.rawlog"}) fs::remove(path(name));
        const Outcome full = run(program, arguments + "/dev/full");
        EXPECT_EQ(full.exitCode, 1) << arguments;
        expectHas(full.err, "/dev/full: could not be written to its end: No space");
        EXPECT_FALSE(fs::exists(path("p.tum")) || fs::exists(path("p.rawlog")))
            << "one of two";
    }
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
    ASSERT_EQ(mapTool("sample " + m + " -n 9 --seed 3 -o /dev/stdout").exitCode, 0);
    const std::string printed = content("stdout");
    ASSERT_EQ(mapTool("sample " + m + " -n 9 --seed 3 -o " + path("s.ply")).exitCode, 0);
    EXPECT_TRUE(printed == content("s.ply"));
}

TEST_F(Outputs, UnwritablePlacesAreSaidAtTheStart) {
    fs::create_directories(path("folder"));
    expectRefused("hgmm-replay", room_ + " --save-map " + path("folder"), "m.hgmm",
                  "folder: is a folder");
    expectRefused("hgmm-replay", room_ + " --save-map " + path("gone/m.hgmm"), "m.hgmm",
                  "gone/m.hgmm: there is no folder");
    expectRefused("hgmm-map", "sample missing.hgmm -n 9 -o " + path("gone/s.ply"), "m.hgmm",
                  "gone/s.ply: there is no folder");
    const Mounted readOnly(path("ro"), MS_RDONLY, nullptr);
    if (!readOnly.isMounted()) GTEST_SKIP() << "only root can mount";
    expectRefused("hgmm-replay", room_ + " --save-map " + path("ro/m.hgmm"), "m.hgmm",
                  "ro/m.hgmm: cannot be written");
    expectRefused("hgmm-replay", room_ + " --report " + path("ro"), "m.hgmm",
                  "ro/metrics.json: cannot be written");
    expectRefused("hgmm-import",
                  pcd_ + " -o " + path("ro/o.rawlog") + " --poses-out " + path("p.tum"),
                  "m.hgmm", "ro/o.rawlog: cannot be written");
}

TEST_F(Outputs, AFullDiskKeepsTheOldFile) {
    const Mounted small(path("small"), 0, "size=64k");
    if (!small.isMounted()) GTEST_SKIP() << "only root can mount";
    const std::string sample = "sample " + path("m.hgmm") + " -o " + path("small/s.ply");
    ASSERT_EQ(mapTool(sample + " -n 100").exitCode, 0);
    const std::string before = content("small/s.ply");
    const Outcome full = mapTool(sample + " -n 10000");
    EXPECT_EQ(full.exitCode, 1);
    expectHas(full.err, "small/s.ply: could not be written to its end: No space");
    EXPECT_TRUE(content("small/s.ply") == before);
    EXPECT_EQ(std::distance(fs::directory_iterator(path("small")), {}), 1);
}
