#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace hgmm::importer {

/// A file and the last number in its name, which orders the files of a recording.
struct NumberedFile {
    std::filesystem::path path;
    long long number = 0;
};

/// The files of a folder whose name ends with a suffix such as ".pcd", in numeric order.
/// Throws std::runtime_error if the folder is missing or has none, or if a name holds no
/// number.
std::vector<NumberedFile> listNumberedFiles(const std::filesystem::path& folder,
                                            const std::string& suffix);

/// The files of a folder whose name ends with a suffix, by name. Throws std::runtime_error
/// if the folder is missing or has none.
std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::string& suffix);

/// The whole file as bytes; throws std::runtime_error if it cannot be read.
std::string readBytes(const std::filesystem::path& file);

/// Throws std::runtime_error "path: what".
[[noreturn]] void failFile(const std::filesystem::path& path, const std::string& what);

}  // namespace hgmm::importer
