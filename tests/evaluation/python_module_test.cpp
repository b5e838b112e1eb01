#include "hgmm/evaluation/python_module.h"

#include <cstdlib>
#include <fstream>

#include "scratch_folder.h"

namespace hgmm::evaluation {
namespace {

/// In place of Python, a shell script.
class PythonModule : public ScratchFolder {
 protected:
    void SetUp() override {
        ScratchFolder::SetUp();
        setenv("HGMM_PYTHON", path("python").c_str(), 1);
    }
    void TearDown() override {
        unsetenv("HGMM_PYTHON");
        ScratchFolder::TearDown();
    }
    void write(const std::string& script) const {
        std::ofstream(path("python")) << "#!/bin/sh\n" << script;
        std::filesystem::permissions(path("python"), std::filesystem::perms::owner_all);
    }
};

TEST_F(PythonModule, GetsTheWordsAsTheyAreAndIsRead) {
    write("printf '%s|' \"$@\"; cat; echo careful >&2\n");
    const PythonRun run = runPython("hgmm.view", {"--", "a 'b' $c\n", ""});
    EXPECT_TRUE(run.done);
    EXPECT_EQ(run.output, "-m|hgmm.view|--|a 'b' $c\n||") << "its input is empty";
    EXPECT_EQ(run.message, "careful\n");
}

TEST_F(PythonModule, LongOutputsComeWhole) {
    write("head -c 3000000 /dev/zero; head -c 1000000 /dev/zero >&2\n");
    const PythonRun run = runPython("m", {});
    EXPECT_TRUE(run.done);
    EXPECT_EQ(run.output.size(), 3000000U);
    EXPECT_EQ(run.message.size(), 1000000U);
}

TEST_F(PythonModule, SaysInOneLineWhyItFailed) {
    write("echo half; echo Traceback >&2; echo 'no luck' >&2; exit 3\n");
    PythonRun run = runPython("m", {});
    EXPECT_FALSE(run.done);
    EXPECT_EQ(run.output, "");
    EXPECT_EQ(run.message, "no luck");
    write("kill -9 $$\n");
    run = runPython("hgmm.view", {});
    EXPECT_FALSE(run.done);
    EXPECT_EQ(run.message, path("python") + " -m hgmm.view failed");
    setenv("HGMM_PYTHON", path("gone").c_str(), 1);
    run = runPython("m", {});
    EXPECT_FALSE(run.done);
    EXPECT_EQ(run.message, path("gone") + " cannot be started: No such file or directory");
}

}  // namespace
}  // namespace hgmm::evaluation
