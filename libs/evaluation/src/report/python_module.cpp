#include "hgmm/evaluation/python_module.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>

namespace hgmm::evaluation {
namespace {

namespace fs = std::filesystem;

using Scratch = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

std::string interpreter() {
    if (const char* named = std::getenv("HGMM_PYTHON")) return named;
    constexpr const char* debians = "/usr/bin/python3";
    return fs::exists(debians) ? debians : "python3";
}

/// Where the package of this build is; empty for an installed program.
fs::path packagesOfBuild() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path packages = program.parent_path().parent_path() / "python";
    return fs::exists(packages / "hgmm" / "__init__.py", error) ? packages : fs::path();
}

/// This process' environment, with the package of this build.
std::vector<std::string> environment() {
    const std::string key = "PYTHONPATH=";
    const fs::path packages = packagesOfBuild();
    std::string path = packages.empty() ? "" : key + packages.string();
    std::vector<std::string> all;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        if (path.empty() || text.compare(0, key.size(), key) != 0)
            all.push_back(text);
        else
            path += ":" + text.substr(key.size());
    }
    if (!path.empty()) all.push_back(path);
    return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

std::string contentOf(std::FILE* file) {
    std::string content;
    std::rewind(file);
    char block[65536];
    for (std::size_t n = 0; (n = std::fread(block, 1, sizeof block, file)) > 0;)
        content.append(block, n);
    return content;
}

/// A program of the package says last, in one line, why it failed.
std::string lastLine(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

/// Its exit status as waitpid has it, or -1 with errno set.
int run(std::vector<std::string> words, std::FILE* out, std::FILE* err) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(err), STDERR_FILENO);
    std::vector<std::string> variables = environment();
    pid_t child = 0;
    errno = posix_spawnp(&child, words.front().c_str(), &actions, nullptr,
                         pointersTo(words).data(), pointersTo(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    if (errno != 0) return -1;
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return -1;
    return status;
}

}  // namespace

PythonRun runPython(const std::string& module, const std::vector<std::string>& arguments) {
    const Scratch out(std::tmpfile(), &std::fclose), err(std::tmpfile(), &std::fclose);
    if (!out || !err) return {false, "", "no temporary file can be made"};
    std::vector<std::string> words{interpreter(), "-m", module};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const int status = run(words, out.get(), err.get());
    if (status == -1)
        return {false, "", words[0] + " cannot be started: " + std::strerror(errno)};
    const std::string message = contentOf(err.get());
    if (status == 0) return {true, contentOf(out.get()), message};
    const std::string why = lastLine(message);
    return {false, "", why.empty() ? words[0] + " -m " + module + " failed" : why};
}

}  // namespace hgmm::evaluation
