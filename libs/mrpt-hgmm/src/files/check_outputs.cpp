#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>

#include "files/output_target.h"
#include "hgmm/mrpt_bridge/output_file.h"

namespace fs = std::filesystem;

namespace hgmm::mrpt_bridge {
namespace {

using FileId = std::pair<dev_t, ino_t>;

std::optional<struct stat> statusOf(const std::string& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return status;
}

FileId idOf(const struct stat& status) {
    return {status.st_dev, status.st_ino};
}

/// As open() decides it; access() asks for the user who started a set-user-id program.
bool mayAccess(int mode, const std::string& file) {
    return ::faccessat(AT_FDCWD, file.c_str(), mode, AT_EACCESS) == 0;
}

void requireFileOrStream(const std::string& file, const struct stat& status) {
    const char* what = nullptr;
    if (S_ISDIR(status.st_mode)) what = "a folder";
    if (S_ISBLK(status.st_mode)) what = "a block device";
    if (S_ISSOCK(status.st_mode)) what = "a socket";
    if (what) failOutput(file, std::string("is ") + what + "; give the name of a file");
    if (!mayAccess(W_OK, file))
        failOutput(file, std::string("cannot be written: ") + std::strerror(errno));
}

void requireReplaceable(const Output& output) {
    const FileKind found = kindOfFile(output.file);
    if (found == output.kind || found == FileKind::empty) return;
    failOutput(output.file, std::string("is ") + nameOf(found) + ", and " +
                                nameOf(output.kind) +
                                " would replace it; give another name, or remove it first");
}

void requireFolder(const std::string& file, const std::string& target) {
    const std::string folder = folderOf(target);
    if (!fs::is_directory(folder)) failOutput(file, "there is no folder " + folder);
    if (!mayAccess(W_OK | X_OK, folder))
        failOutput(file,
                   "cannot be written: its folder: " + std::string(std::strerror(errno)));
}

/// Where two names of one file are the same.
std::string uniqueName(const std::string& target) {
    std::error_code error;
    const fs::path folder = fs::canonical(folderOf(target), error);
    return (folder / fs::path(target).filename()).string();
}

void checkOutput(const Output& output, const std::set<FileId>& inputs, Replace replace) {
    const std::string& file = output.file;
    const auto status = statusOf(file);
    if (status) {
        requireFileOrStream(file, *status);
        if (S_ISREG(status->st_mode) && inputs.count(idOf(*status)) > 0)
            failOutput(file, "is an input of this run; give the output another name");
    }
    const OutputTarget target = targetOf(file);
    if (target.isDirect) return;
    if (fs::path(target.file).filename().empty()) failOutput(file, "is no name of a file");
    requireFolder(file, target.file);
    if (status && replace == Replace::sameKind) requireReplaceable(output);
}

}  // namespace

void checkOutputs(const std::vector<Output>& outputs,
                  const std::vector<std::string>& inputs, Replace replace) {
    std::set<FileId> inputIds;
    for (const std::string& input : inputs)
        if (const auto status = statusOf(input)) inputIds.insert(idOf(*status));
    std::set<std::string> targets;
    for (const Output& output : outputs) {
        if (output.file.empty()) continue;
        checkOutput(output, inputIds, replace);
        const OutputTarget target = targetOf(output.file);
        if (!target.isDirect && !targets.insert(uniqueName(target.file)).second)
            failOutput(output.file, "two outputs would be this file; give them two names");
    }
}

}  // namespace hgmm::mrpt_bridge
