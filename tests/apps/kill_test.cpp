#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <iostream>
#include <random>
#include <thread>

#include "pcd_files.h"
#include "replay_map_fixture.h"

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;
using Clock = std::chrono::steady_clock;

/// Ends programs with SIGKILL at random moments: HGMM_KILLS times each, 20 if unset.
class Kill : public ReplayFolder {
 protected:
    static int kills() {
        const char* said = std::getenv("HGMM_KILLS");
        return said ? std::max(1, std::atoi(said)) : 20;
    }
    static pid_t start(const Words& words) {
        const pid_t child = fork();
        if (child != 0) return child;
        std::vector<char*> arguments;
        for (const std::string& word : words)
            arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        const int null = ::open("/dev/null", O_RDWR);
        for (int stream = 0; stream < 3; ++stream) ::dup2(null, stream);
        ::execv(arguments[0], arguments.data());
        ::_exit(99);
    }
    static void expectDone(const Words& words) {
        int status = 0;
        ::waitpid(start(words), &status, 0);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << words[0];
    }
    std::vector<std::string> contents(const Words& names) const {
        std::vector<std::string> all;
        for (const std::string& name : names) all.push_back(content(name));
        return all;
    }
    bool isLeftoverOf(const fs::path& file, const std::string& name) const {
        return file.filename().string().rfind(name + ".part", 0) == 0;
    }
    bool hasWholeLeftover(const std::string& name, const std::string& whole) const {
        for (const auto& entry : fs::directory_iterator(path("")))
            if (isLeftoverOf(entry.path(), name) &&
                content(entry.path().filename()) == whole)
                return true;
        return false;
    }
    /// Outputs, in the order in which they get their names, are old or new, and all new if
    /// the last is. A mixture of both can only be seen between two renames, when what has
    /// no name yet is whole.
    bool isOldOrNew(const Words& outputs, const std::vector<std::string>& old,
                    const std::vector<std::string>& made) const {
        bool allNew = true;
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            const std::string now = content(outputs[i]);
            EXPECT_TRUE(now == old[i] || now == made[i]) << outputs[i];
            if (i > 0 && (now == made[i]) != allNew) {
                EXPECT_TRUE(allNew && hasWholeLeftover(outputs[i], made[i])) << outputs[i];
            }
            allNew = allNew && now == made[i];
        }
        return allNew;
    }
    /// @param makeOld, makeNew commands that write the outputs, with different content
    void killOften(const Words& makeOld, const Words& makeNew, const Words& outputs) {
        expectDone(makeOld);
        const auto old = contents(outputs);
        const auto began = Clock::now();
        expectDone(makeNew);
        std::chrono::duration<double> whole_s = Clock::now() - began;
        const auto made = contents(outputs);
        for (std::size_t i = 0; i < outputs.size(); ++i) ASSERT_TRUE(old[i] != made[i]);

        std::mt19937 engine(1);
        int finished = 0;
        for (int i = 0; i < kills(); ++i) {
            for (std::size_t k = 0; k < outputs.size(); ++k)
                std::ofstream(path(outputs[k]), std::ios::binary) << old[k];
            // Anywhere in the run, and every other time towards its end, where files are
            // written.
            std::uniform_real_distribution<double> share(i % 2 == 0 ? 0.0 : 0.8, 1.1);
            const pid_t child = start(makeNew);
            std::this_thread::sleep_for(share(engine) * whole_s);
            ::kill(child, SIGKILL);
            ::waitpid(child, nullptr, 0);
            const bool isDone = isOldOrNew(outputs, old, made);
            finished += isDone ? 1 : 0;
            whole_s *= isDone ? 0.9 : 1.1;  // other processes make runs slow and fast
        }
        expectDone(makeNew);
        EXPECT_TRUE(contents(outputs) == made);
        for (const auto& entry : fs::directory_iterator(path("")))
            for (const std::string& name : outputs)
                EXPECT_FALSE(isLeftoverOf(entry.path(), name)) << entry;
        std::cout << makeNew[0] << ": " << kills() << " kills, " << finished
                  << " after the new file was there, none left a broken file\n";
    }
    static std::string program(const std::string& name) {
        return std::string(HGMM_BIN_DIR) + "/" + name;
    }
};

}  // namespace

TEST_F(Kill, ReplayLeavesTheOldOrTheNewMap) {
    recordRoom(6, 2000);
    const Words command{program("hgmm-replay"), path("room.rawlog"), "--poses",
                        path("room.tum"),       "--save-map",        path("m.hgmm")};
    Words older = command;
    older.insert(older.end(), {"--to", "2"});
    killOften(older, command, {"m.hgmm"});
}

TEST_F(Kill, MapLeavesTheOldOrTheNewFile) {
    ASSERT_EQ(replay(recordRoom(3, 1000) + " --save-map " + path("m.hgmm")).exitCode, 0);
    const Words command{program("hgmm-map"), "sample", path("m.hgmm"), "-o",
                        path("s.ply"),       "-n"};
    Words older = command, newer = command;
    older.emplace_back("1000");
    newer.emplace_back("1000000");
    killOften(older, newer, {"s.ply"});
}

TEST_F(Kill, ImportLeavesTheOldOrTheNewPair) {
    fs::create_directories(path("in"));
    std::string poses;
    for (int i = 0; i < 40; ++i) {
        std::string points;
        for (int k = 0; k < 500; ++k)
            points += std::to_string(1 + 0.01 * k) + " 2 " + std::to_string(i) + "\n";
        std::ofstream(path("in/" + std::to_string(i) + ".pcd"))
            << import_test::asciiPcd(500, points);
        poses += std::to_string(i) + " 0 0 0 0 0 0 1\n";
    }
    std::ofstream(path("poses.txt")) << poses;
    const Words command{program("hgmm-import"), "pcd", path("in"),       "--poses",
                        path("poses.txt"),      "-o",  path("o.rawlog"), "--poses-out",
                        path("o.tum")};
    Words older = command;
    older.insert(older.end(), {"--step", "2"});
    killOften(older, command, {"o.tum", "o.rawlog"});
}
