#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace hgmm::fuzz {

/// A folder in memory for the files that a harness' bytes stand for: a line "@@ NAME"
/// begins the file NAME, which goes on to the next such line.
class RecordingFolder {
 public:
    RecordingFolder(const std::uint8_t* data, std::size_t size)
        : path_("/dev/shm/hgmm-fuzz-" + std::to_string(getpid())) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_ / "velodyne");
        const std::string text(reinterpret_cast<const char*>(data), size);
        for (std::size_t at = text.find("@@ "); at != std::string::npos;) {
            const std::size_t line = text.find('\n', at);
            if (line == std::string::npos) return;
            const std::string name = text.substr(at + 3, line - at - 3);
            at = text.find("@@ ", line);
            write(name,
                  text.substr(line + 1, at == std::string::npos ? at : at - line - 1));
        }
    }
    ~RecordingFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    RecordingFolder(const RecordingFolder&) = delete;
    RecordingFolder& operator=(const RecordingFolder&) = delete;

    std::string path() const { return path_.string(); }
    std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
    void write(const std::string& name, const std::string& content) const {
        const bool isInside = name.find("..") == std::string::npos && !name.empty() &&
                              name.front() != '/' && name.find('\0') == std::string::npos;
        if (isInside) std::ofstream(path_ / name, std::ios::binary) << content;
    }
    std::filesystem::path path_;
};

}  // namespace hgmm::fuzz
