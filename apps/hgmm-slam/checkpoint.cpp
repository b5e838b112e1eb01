#include "checkpoint.h"

#include <hgmm/mrpt_bridge/output_file.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace fs = std::filesystem;

namespace hgmm::slam_app {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Layout: the magic, then blocks of a u64 length and its bytes: names and values of what
// was given, each a block; SavedRun's numbers, and how many submaps are files; the mark of
// each of these; odometry; slam. Both of these have checksums of their own.
constexpr std::string_view kMagic = "HGMC2\n";

std::string contentOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file + ": cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

void putBlock(std::string& out, const void* data, std::uint64_t size) {
    out.append(reinterpret_cast<const char*>(&size), sizeof size);
    out.append(static_cast<const char*>(data), size);
}
void putBlock(std::string& out, const std::string& text) {
    putBlock(out, text.data(), text.size());
}

/// Takes a block off the front of what is left. Throws std::out_of_range.
std::string_view takeBlock(std::string_view& left) {
    std::uint64_t size = 0;
    if (left.size() < sizeof size) throw std::out_of_range("it ends too early");
    std::memcpy(&size, left.data(), sizeof size);
    left.remove_prefix(sizeof size);
    if (size > left.size()) throw std::out_of_range("it ends too early");
    const std::string_view block = left.substr(0, size);
    left.remove_prefix(size);
    return block;
}

Bytes bytesOf(std::string_view text) {
    return {text.begin(), text.end()};
}

/// Tells contents from others: a state does not go on with submaps of another run.
std::string contentMark(std::string_view content) {
    return std::to_string(content.size()) + ' ' +
           std::to_string(std::hash<std::string_view>()(content));
}

/// Tells a file from others: its size, and its first megabyte.
std::string fingerprint(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::string start(std::size_t{1} << 20U, '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(in.gcount()));
    std::error_code error;
    const auto size = fs::file_size(file, error);
    return std::to_string(error ? 0 : size) + ' ' +
           std::to_string(std::hash<std::string>()(start));
}

std::string mapOptions(const mrpt::maps::CHGMMOccupancyMap& map) {
    std::ostringstream text;
    map.insertionOptions.dumpToTextStream(text);
    return text.str();
}

}  // namespace

Checkpoint::Checkpoint(const Options& o, const mrpt::maps::CHGMMOccupancyMap& map,
                       const std::optional<std::string>& sensorLabel)
    : folder_(o.folder + "/unfinished"), saveEvery_s_(o.saveEvery_s) {
    given_ = {{"recording", fingerprint(o.log)},
              {"version of the program", HGMM_VERSION},
              {"map options", mapOptions(map)},
              {"--continue", o.earlier.value_or("")},
              {"--odometry", o.odometry ? fingerprint(*o.odometry) : ""},
              {"--ignore-odometry", o.ignoreOdometry ? "yes" : "no"},
              {"--sensor", sensorLabel.value_or("")},
              {"--from", std::to_string(o.from)},
              {"--to", std::to_string(o.to)}};
}

std::optional<SavedRun> Checkpoint::load() {
    if (!fs::exists(stateFile())) return std::nullopt;
    const std::string content = contentOf(stateFile());
    std::string_view left(content);
    if (left.substr(0, kMagic.size()) != kMagic)
        throw std::runtime_error(stateFile() + ": is not the state of a run");
    left.remove_prefix(kMagic.size());
    try {
        for (const auto& [name, value] : given_)
            if (takeBlock(left) != name || takeBlock(left) != value)
                throw std::runtime_error(
                    folder_ + ": holds a run that was not finished, with another " + name +
                    ". The command of that run goes on with it; --restart discards it");
        SavedRun run;
        std::istringstream numbers{std::string(takeBlock(left))};
        std::size_t submaps = 0;
        if (!(numbers >> run.scans >> run.scansLost >> run.seconds >> submaps))
            throw std::out_of_range("it is damaged");
        marks_.clear();
        for (std::size_t k = 0; k < submaps; ++k) marks_.emplace_back(takeBlock(left));
        run.odometry = bytesOf(takeBlock(left));
        run.slam = bytesOf(takeBlock(left));
        return run;
    } catch (const std::out_of_range& e) {
        throw std::runtime_error(stateFile() + ": " + e.what() + "; --restart discards it");
    }
}

std::vector<std::uint8_t> Checkpoint::submap(std::size_t k) {
    const std::string content = contentOf(submapFile(k));
    if (k >= marks_.size() || contentMark(content) != marks_[k])
        throw std::runtime_error(submapFile(k) + ": is damaged, or of another run");
    return bytesOf(content);
}

bool Checkpoint::isDue() const {
    return std::chrono::duration<double>(Clock::now() - saved_).count() >= saveEvery_s_;
}

bool Checkpoint::save(SavedRun run, const slam::Odometry& odometry,
                      const slam::SubmapSlam& slam) {
    run.odometry = odometry.save();
    run.slam = slam.save();
    saved_ = Clock::now();
    try {
        write(run, slam);
        return true;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "warning: %s; the state of the run was not saved\n", e.what());
        return false;
    }
}

void Checkpoint::write(const SavedRun& run, const slam::SubmapSlam& slam) {
    fs::create_directories(folder_);
    while (marks_.size() < slam.finishedSubmaps()) {
        const Bytes bytes = slam.saveSubmap(marks_.size());
        const std::string content(bytes.begin(), bytes.end());
        mrpt_bridge::writeFile(submapFile(marks_.size()), content);
        marks_.push_back(contentMark(content));
    }
    std::string content(kMagic);
    for (const auto& [name, value] : given_) {
        putBlock(content, name);
        putBlock(content, value);
    }
    putBlock(content, std::to_string(run.scans) + ' ' + std::to_string(run.scansLost) +
                          ' ' + std::to_string(run.seconds) + ' ' +
                          std::to_string(marks_.size()));
    for (const std::string& mark : marks_) putBlock(content, mark);
    putBlock(content, run.odometry.data(), run.odometry.size());
    putBlock(content, run.slam.data(), run.slam.size());
    mrpt_bridge::writeFile(stateFile(), content);
}

void Checkpoint::remove() {
    std::error_code error;  // other leftovers do no harm: without a state, nothing goes on
    fs::remove(stateFile(), error);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_, error))
        files.push_back(entry.path());
    for (const fs::path& file : files) {
        const std::string name = file.filename().string();
        if (name.rfind("submap-", 0) == 0 || name.rfind("state.part", 0) == 0)
            fs::remove(file, error);
    }
    fs::remove(folder_, error);
    marks_.clear();
    if (fs::exists(stateFile())) throw std::runtime_error(stateFile() + ": stays");
}

}  // namespace hgmm::slam_app
