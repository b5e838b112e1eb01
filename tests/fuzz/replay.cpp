// A harness as a test: runs it on files, and on all files of folders.
//   NAME PATH ...           exit code 1 if a promise is broken
//   NAME --random N FIRST   on the random inputs from number FIRST on; writes those that
//                           broke a promise to broken-NUMBER
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "harness.h"

namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

bool holdsFor(const Input& input, const std::string& name) {
    try {
        hgmm::fuzz::runOne(input.data(), input.size());
        return true;
    } catch (const std::exception& e) {
        std::cerr << name << ": " << e.what() << '\n';
        return false;
    }
}

std::vector<fs::path> filesOf(const fs::path& path) {
    if (!fs::is_directory(path)) return {path};
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(path))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

int runFiles(const std::vector<fs::path>& files) {
    std::size_t broken = 0;
    for (const fs::path& path : files) {
        std::ifstream file(path, std::ios::binary);
        const Input input{std::istreambuf_iterator<char>(file), {}};
        if (!file.is_open() || !holdsFor(input, path.string())) ++broken;
    }
    std::cout << files.size() << " inputs, " << broken << " broke a promise\n";
    return files.empty() || broken > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}

/// Input k depends on k alone.
Input randomInput(std::uint64_t k) {
    constexpr std::size_t kLongest = 512;
    std::mt19937_64 random(k);
    Input input(1 + random() % kLongest);
    for (std::uint8_t& byte : input) byte = static_cast<std::uint8_t>(random() >> 32U);
    return input;
}

int runRandom(std::uint64_t count, std::uint64_t first) {
    std::uint64_t broken = 0;
    for (std::uint64_t k = first; k < first + count; ++k) {
        const Input input = randomInput(k);
        if (holdsFor(input, "input " + std::to_string(k))) continue;
        ++broken;
        std::ofstream("broken-" + std::to_string(k), std::ios::binary)
            .write(reinterpret_cast<const char*>(input.data()),
                   static_cast<std::streamsize>(input.size()));
    }
    std::cout << "random inputs from " << first << " to " << first + count - 1 << ": "
              << broken << " of " << count << " broke a promise\n";
    return broken > 0 ? EXIT_FAILURE : EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.size() == 3 && arguments[0] == "--random")
        return runRandom(std::stoull(arguments[1]), std::stoull(arguments[2]));
    std::vector<fs::path> files;
    for (const std::string& argument : arguments)
        for (const fs::path& file : filesOf(argument)) files.push_back(file);
    return runFiles(files);
}
