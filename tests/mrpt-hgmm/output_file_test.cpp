#include "hgmm/mrpt_bridge/output_file.h"

#include <gtest/gtest.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/poses/CPose3D.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "../evaluation/scratch_folder.h"

namespace {

using namespace hgmm::mrpt_bridge;
namespace fs = std::filesystem;

/// Root may write anywhere, so it becomes another user, who owns the folder, for a while.
class AsOrdinaryUser {
 public:
    explicit AsOrdinaryUser(const std::string& folder) {
        constexpr uid_t nobody = 65534;
        if (user_ != 0) return;
        EXPECT_EQ(::chown(folder.c_str(), nobody, static_cast<gid_t>(-1)), 0);
        EXPECT_EQ(::seteuid(nobody), 0);
    }
    ~AsOrdinaryUser() { EXPECT_EQ(::seteuid(user_), 0); }
    AsOrdinaryUser(const AsOrdinaryUser&) = delete;
    AsOrdinaryUser& operator=(const AsOrdinaryUser&) = delete;

 private:
    uid_t user_ = ::geteuid();
};

class OutputFiles : public ScratchFolder {
 protected:
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }
    std::string content(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::size_t filesHere() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path("")), fs::directory_iterator()));
    }
    /// What checkOutputs says; empty if nothing.
    static std::string refusal(const Output& output,
                               const std::vector<std::string>& inputs = {},
                               Replace replace = Replace::sameKind) {
        try {
            checkOutputs({output}, inputs, replace);
            return "";
        } catch (const std::runtime_error& e) {
            return e.what();
        }
    }
    static bool has(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
    /// A process that has begun to write a file, and waits.
    pid_t startWriter(const std::string& name) const {
        int ready[2];
        if (pipe(ready) != 0) return -1;
        const pid_t child = fork();
        if (child == 0) {
            OutputFile file({path(name), FileKind::text});
            file.write("half", 4);
            if (::write(ready[1], "x", 1) != 1) _exit(1);
            for (;;) pause();
        }
        char byte = 0;
        EXPECT_EQ(::read(ready[0], &byte, 1), 1);
        ::close(ready[0]);
        ::close(ready[1]);
        return child;
    }
    static void end(pid_t child) {
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
    }
};

TEST_F(OutputFiles, KindsAreToldByTheirStarts) {
    EXPECT_EQ(kindOf(""), FileKind::empty);
    EXPECT_EQ(kindOf("ply\nformat ascii 1.0\n"), FileKind::ply);
    EXPECT_EQ(kindOf("plywood is wood\n"), FileKind::text);
    EXPECT_EQ(kindOf("\x89PNG\r\n\x1a\n"), FileKind::png);
    EXPECT_EQ(kindOf("P5\n2 2\n255\n"), FileKind::pgm);
    EXPECT_EQ(kindOf("glTF\x02"), FileKind::gltf);
    EXPECT_EQ(kindOf("# Octomap OcTree binary file\n"), FileKind::octree);
    EXPECT_EQ(kindOf("image: a.pgm\n"), FileKind::slice);
    EXPECT_EQ(kindOf("{\"a\": 1}"), FileKind::json);
    EXPECT_EQ(kindOf("<!DOCTYPE html>\n"), FileKind::html);
    EXPECT_EQ(kindOf("<svg width=\"1\">"), FileKind::svg);
    EXPECT_EQ(kindOf("# t x y\n\n  -1.5e3 2 3\n"), FileKind::numbers);
    EXPECT_EQ(kindOf("# words\n[section]\nkey = 1\n"), FileKind::text);
    EXPECT_EQ(kindOf(std::string("a\0b", 3)), FileKind::other);
    EXPECT_EQ(kindOf("\x9dmrpt::maps::CHGMMOccupancyMap\x02"), FileKind::map);
    EXPECT_EQ(kindOf("\x1amrpt::obs::CObservation3D..."), FileKind::other);
    EXPECT_EQ(kindOf("\x98mrpt::obs::CSensoryFrame\x01"), FileKind::rawlog);
    EXPECT_EQ(kindOfFile(HGMM_TEST_DATA "/map_v2.hgmm"), FileKind::map);
    EXPECT_EQ(kindOfFile(HGMM_TEST_DATA "/map_v2.txt"), FileKind::numbers);
    EXPECT_EQ(kindOfFile(path("none")), FileKind::other);
}

TEST_F(OutputFiles, WhatIsWrittenIsRecognised) {
    OutputFile scene({path("a.3Dscene"), FileKind::scene});
    writeObject(scene, mrpt::opengl::COpenGLScene());
    scene.commit();
    EXPECT_EQ(kindOfFile(path("a.3Dscene")), FileKind::scene);
    mrpt::opengl::COpenGLScene loaded;
    EXPECT_TRUE(loaded.loadFromFile(path("a.3Dscene")));
    EXPECT_EQ(refusal({path("a.3Dscene"), FileKind::scene}), "");
}

TEST_F(OutputFiles, ReplaceTheirKindOnlyUnlessAsked) {
    put("a", "1 2 3\n");
    writeFile(path("a"), "4 5 6\n");
    EXPECT_EQ(content("a"), "4 5 6\n");
    EXPECT_THROW(writeFile(path("a"), "ply\nformat"), std::runtime_error);
    EXPECT_EQ(content("a"), "4 5 6\n");
    const std::string said = refusal({path("a"), FileKind::ply});
    EXPECT_TRUE(has(said, path("a") + ": is a file of numbers, and a PLY file")) << said;
    writeFile(path("a"), "ply\nformat", Replace::anyKind);
    EXPECT_EQ(content("a"), "ply\nformat");
    put("nothing", "");
    writeFile(path("nothing"), "4 5 6\n");
    EXPECT_EQ(content("nothing"), "4 5 6\n");
    EXPECT_EQ(filesHere(), 2U) << "a temporary file stayed";
}

TEST_F(OutputFiles, NeverReplaceInputs) {
    put("in", "1 2 3\n");
    fs::create_symlink(path("in"), path("soft"));
    fs::create_hard_link(path("in"), path("hard"));
    for (const char* name : {"in", "soft", "hard", "./in"})
        for (const Replace replace : {Replace::sameKind, Replace::anyKind})
            EXPECT_TRUE(has(refusal({path(name), FileKind::numbers},
                                    {path("other"), path("in")}, replace),
                            "is an input of this run"))
                << name;
    EXPECT_TRUE(has(refusal({path("in"), FileKind::numbers}, {path("soft")}), "input"));
    EXPECT_EQ(refusal({path("out"), FileKind::numbers}, {path("in")}), "");
    EXPECT_EQ(refusal({"/dev/null", FileKind::numbers}, {"/dev/null"}), "");
}

TEST_F(OutputFiles, AreNotNamedTwice) {
    fs::create_symlink(path("a"), path("link"));
    const Output a{path("a"), FileKind::text};
    EXPECT_THROW(checkOutputs({a, {path("b"), FileKind::text}, a}, {}), std::runtime_error);
    EXPECT_THROW(checkOutputs({a, {path("link"), FileKind::text}}, {}), std::runtime_error);
    EXPECT_NO_THROW(checkOutputs({a, {path("b"), FileKind::text}, {"", {}}, {"", {}}}, {}));
    EXPECT_NO_THROW(checkOutputs({{"/dev/null", {}}, {"/dev/null", {}}}, {}));
}

TEST_F(OutputFiles, SymbolicLinksStayAndTheirTargetsAreReplaced) {
    fs::create_directories(path("there"));
    put("there/a", "old\n");
    fs::create_symlink("there/a", path("near"));
    fs::create_symlink("near", path("far"));
    fs::create_symlink("there/new", path("dangling"));
    writeFile(path("far"), "new\n");
    EXPECT_TRUE(fs::is_symlink(path("far")) && fs::is_symlink(path("near")));
    EXPECT_FALSE(fs::is_symlink(path("there/a")));
    EXPECT_EQ(content("there/a"), "new\n");
    writeFile(path("dangling"), "first\n");
    EXPECT_TRUE(fs::is_symlink(path("dangling")));
    EXPECT_EQ(content("there/new"), "first\n");
    fs::create_symlink("circle", path("circle"));
    EXPECT_TRUE(has(refusal({path("circle"), FileKind::text}), "circle"));
}

TEST_F(OutputFiles, RefuseWhatIsNoFile) {
    fs::create_directories(path("folder"));
    EXPECT_TRUE(has(refusal({path("folder"), FileKind::text}), "is a folder"));
    EXPECT_TRUE(has(refusal({path("folder/"), FileKind::text}), "is a folder"));
    EXPECT_TRUE(has(refusal({path("none/a"), FileKind::text}), "there is no folder"));
    EXPECT_TRUE(has(refusal({path("new/"), FileKind::text}), path("new/")));
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name = path("s");
    ASSERT_LT(name.size(), sizeof address.sun_path);
    std::copy(name.begin(), name.end(), address.sun_path);
    ASSERT_EQ(
        ::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_TRUE(has(refusal({name, FileKind::text}, {}, Replace::anyKind), "is a socket"));
    ::close(descriptor);
}

TEST_F(OutputFiles, RefuseBlockDevices) {
    if (::mknod(path("disk").c_str(), S_IFBLK | 0600, 0) != 0)
        GTEST_SKIP() << "block devices cannot be made here";
    EXPECT_TRUE(has(refusal({path("disk"), FileKind::text}, {}, Replace::anyKind),
                    "is a block device"));
}

TEST_F(OutputFiles, WriteDevicesAndPipesDirectly) {
    writeFile("/dev/null", "text");
    struct stat status {};
    ASSERT_EQ(::stat("/dev/null", &status), 0);
    EXPECT_TRUE(S_ISCHR(status.st_mode));
    try {
        writeFile("/dev/full", "text");
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_TRUE(has(e.what(), "/dev/full: could not be written to its end: No space"))
            << e.what();
    }
    OutputFile full({"/dev/full", FileKind::map});
    EXPECT_THROW(writeObject(full, mrpt::poses::CPose3D()), std::runtime_error);
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    const pid_t child = fork();
    if (child == 0) {
        writeFile(path("pipe"), "through");
        _exit(0);
    }
    EXPECT_EQ(content("pipe"), "through");
    int result = -1;
    ::waitpid(child, &result, 0);
    EXPECT_EQ(result, 0);
    EXPECT_TRUE(fs::is_fifo(path("pipe")));
}

TEST_F(OutputFiles, RefuseReadOnlyPlaces) {
    const AsOrdinaryUser ordinary(path(""));
    put("a", "old\n");
    EXPECT_EQ(refusal({path("a"), FileKind::text}), "");
    fs::permissions(path("a"), fs::perms::owner_read);
    EXPECT_TRUE(has(refusal({path("a"), FileKind::text}), "cannot be written"));
    fs::create_directories(path("closed"));
    fs::permissions(path("closed"), fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_TRUE(has(refusal({path("closed/a"), FileKind::text}), "cannot be written"));
    fs::permissions(path("closed"), fs::perms::owner_all);
}

TEST_F(OutputFiles, KeepPermissions) {
    put("a", "old\n");
    fs::permissions(path("a"), fs::perms::owner_read | fs::perms::owner_write);
    writeFile(path("a"), "new\n");
    EXPECT_EQ(fs::status(path("a")).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(OutputFiles, WhatIsNotCommittedLeavesTheOldFile) {
    put("a", "old\n");
    {
        OutputFile file({path("a"), FileKind::text});
        file.write("new\n", 4);
    }
    EXPECT_EQ(content("a"), "old\n");
    EXPECT_EQ(filesHere(), 1U);
}

TEST_F(OutputFiles, AllAreReplacedOrNone) {
    put("a", "old\n");
    for (const bool fails : {true, false}) {
        OutputFile a({path("a"), FileKind::text}), b({path("b"), FileKind::text}),
            c({path("c"), FileKind::text});
        for (OutputFile* file : {&a, &b, &c}) file->write("new\n", 4);
        if (fails) {
            fs::create_directories(path("c/in the way"));
            EXPECT_THROW(OutputFile::commitAll({&a, &b, &c}), std::runtime_error);
            EXPECT_EQ(content("a"), "old\n");
            EXPECT_FALSE(fs::exists(path("b")));
            fs::remove_all(path("c"));
        } else {
            OutputFile::commitAll({&a, &b, &c});
        }
    }
    for (const char* name : {"a", "b", "c"}) EXPECT_EQ(content(name), "new\n");
    EXPECT_EQ(filesHere(), 3U);
}

TEST_F(OutputFiles, LeftoversOfKilledProcessesAreRemoved) {
    const pid_t child = startWriter("a");
    ASSERT_GT(child, 0);
    const std::string leftover = "a.part" + std::to_string(child);
    ASSERT_TRUE(fs::exists(path(leftover)));
    for (const char* name : {"a.part", "a.partial", "a.part7x", "b.part999999"})
        put(name, "of somebody else");
    writeFile(path("a"), "by another while that writes\n");
    EXPECT_EQ(content(leftover), "half") << "its process still writes";
    end(child);
    testing::internal::CaptureStderr();
    writeFile(path("a"), "later\n");
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(has(said, leftover)) << said;
    EXPECT_EQ(content("a"), "later\n");
    EXPECT_EQ(filesHere(), 5U);
}

TEST_F(OutputFiles, ALeftoverWithOurNumberDoesNotStop) {
    // In containers, each run may have the same number.
    put("a.part" + std::to_string(::getpid()), "half");
    writeFile(path("a"), "whole\n");
    EXPECT_EQ(content("a"), "whole\n");
    EXPECT_EQ(filesHere(), 1U);
}

}  // namespace
