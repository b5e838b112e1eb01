#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

/// Runs programs of MRPT as users do: as they are, with our plugin preloaded.
namespace stock_app {

struct Result {
    int exitCode = -1;
    std::string output;  ///< stdout and stderr
};

/// Value of LD_PRELOAD: a sanitizer's runtime must come before all else.
inline std::string preload() {
#ifdef HGMM_ASAN_RUNTIME
    return std::string(HGMM_ASAN_RUNTIME) + ":" + HGMM_PLUGIN_FILE;
#else
    return HGMM_PLUGIN_FILE;
#endif
}

/// Quotes a word for the shell.
inline std::string quoted(const std::string& word) {
    return "'" + word + "'";
}

/// Runs a command line in `folder`, at most `timeout_s` seconds, without input: some
/// programs wait for a key after an error.
inline Result run(const std::string& commandLine, const std::filesystem::path& folder,
                  int timeout_s = 300, bool withPlugin = true) {
    const auto log = folder / "stock_app.log";
    std::string environment = "ASAN_OPTIONS=detect_leaks=0 OMP_WAIT_POLICY=passive ";
    if (withPlugin) environment += "LD_PRELOAD=" + quoted(preload()) + " ";
    // Not `env` in front of `timeout`: the plugin goes to the program alone.
    const std::string line = "cd " + quoted(folder.string()) + " && timeout " +
                             std::to_string(timeout_s) + " env " + environment +
                             commandLine + " </dev/null >" + quoted(log.string()) + " 2>&1";
    Result result;
    const int status = std::system(line.c_str());
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    std::ifstream in(log);
    result.output.assign(std::istreambuf_iterator<char>(in), {});
    return result;
}

}  // namespace stock_app
