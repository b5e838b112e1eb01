#pragma once
#include <string>

namespace hgmm::importer {

/// A file that appears under its name only when it is complete. Until commit() it is
/// written as NAME.tmp, which is removed if this object dies first.
class OutputFile {
 public:
    explicit OutputFile(std::string path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    const std::string& path() const { return path_; }
    const std::string& temporaryPath() const { return temporaryPath_; }
    /// Renames. Throws std::runtime_error that names the file.
    void commit();

 private:
    std::string path_, temporaryPath_;
    bool committed_ = false;
};

}  // namespace hgmm::importer
