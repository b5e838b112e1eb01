#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "../evaluation/box_room.h"
#include "../evaluation/scratch_folder.h"

/// Runs hgmm-replay and hgmm-map on small recordings of a box room.
class ReplayFolder : public ScratchFolder {
 protected:
    /// Reports are without their page, which takes Python seconds to make.
    void SetUp() override {
        ScratchFolder::SetUp();
        setenv("HGMM_PYTHON", "/nowhere/python3", 1);
    }

    struct Outcome {
        int exitCode = -1;
        std::string out;  ///< stdout
        std::string err;  ///< stderr
    };

    Outcome run(const std::string& program, const std::string& arguments) const {
        const std::string command = std::string(HGMM_BIN_DIR) + "/" + program + " " +
                                    arguments + " >'" + path("stdout") + "' 2>'" +
                                    path("stderr") + "' </dev/null";
        const int status = std::system(command.c_str());
        Outcome outcome;
        outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        outcome.out = content("stdout");
        outcome.err = content("stderr");
        return outcome;
    }
    Outcome replay(const std::string& arguments) const {
        return run("hgmm-replay", arguments);
    }
    Outcome mapTool(const std::string& arguments) const {
        return run("hgmm-map", arguments);
    }

    std::string content(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    /// "LOG --poses POSES" of a recording of the room.
    std::string recordRoom(std::size_t scans = 12, std::size_t pointsPerScan = 3000,
                           double drift_m = 0) const {
        box_room::writeRawlog(path("room.rawlog"),
                              box_room::observations(scans, pointsPerScan));
        box_room::writePoses(path("room.tum"), scans, drift_m);
        return "'" + path("room.rawlog") + "' --poses '" + path("room.tum") + "'";
    }

    nlohmann::json metrics(const std::string& folder) const {
        return nlohmann::json::parse(content(folder + "/metrics.json"));
    }

    static void expectHas(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" in: " << text;
    }
};
