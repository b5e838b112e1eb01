#include "output_file.h"

#include <filesystem>
#include <utility>

#include "files.h"

namespace hgmm::importer {

OutputFile::OutputFile(std::string path)
    : path_(std::move(path)), temporaryPath_(path_ + ".tmp") {}

OutputFile::~OutputFile() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporaryPath_, ignored);
}

void OutputFile::commit() {
    std::error_code error;
    std::filesystem::rename(temporaryPath_, path_, error);
    if (error)
        failFile(path_, "cannot be written (" + error.message() + "); give another path");
    committed_ = true;
}

}  // namespace hgmm::importer
