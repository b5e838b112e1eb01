#include "files/output_target.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>

namespace fs = std::filesystem;

namespace hgmm::mrpt_bridge {
namespace {

/// Links of /proc lead to open descriptors, whatever is behind these.
bool isOfProc(const struct stat& link) {
    struct stat proc {};
    return ::stat("/proc/self", &proc) == 0 && proc.st_dev == link.st_dev;
}

/// The process that made NAME.partPID or NAME.partPID-SUFFIX; nothing for other names.
std::optional<pid_t> makerOf(const std::string& name, const std::string& target) {
    const std::string start = target + ".part";
    if (name.compare(0, start.size(), start) != 0) return std::nullopt;
    const char* const end = name.data() + name.size();
    pid_t pid = 0;
    const auto [at, error] = std::from_chars(name.data() + start.size(), end, pid);
    if (error != std::errc() || pid <= 0 || (at != end && *at != '-')) return std::nullopt;
    return pid;
}

bool runs(pid_t pid) {
    return ::kill(pid, 0) == 0 || errno != ESRCH;
}

/// A file that is being written is locked, also where process numbers mean nothing: in
/// another container, or given out anew.
bool isLocked(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) return true;
    const bool isFree = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    ::close(descriptor);
    return !isFree;
}

}  // namespace

void failOutput(const std::string& file, const std::string& what) {
    throw std::runtime_error(file + ": " + what);
}

std::string folderOf(const std::string& file) {
    const std::string folder = fs::path(file).parent_path().string();
    return folder.empty() ? "." : folder;
}

OutputTarget targetOf(const std::string& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0 &&
        (S_ISCHR(status.st_mode) || S_ISFIFO(status.st_mode)))
        return {file, true};
    constexpr int mostLinks = 40;  // as the kernel has it
    fs::path path(file);
    for (int i = 0; i < mostLinks; ++i) {
        if (::lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode))
            return {path.string(), false};
        if (isOfProc(status)) return {file, true};
        path = path.parent_path() / fs::read_symlink(path);
    }
    failOutput(file, "its symbolic links lead in a circle");
}

void removeLeftovers(const std::string& target) {
    const std::string name = fs::path(target).filename().string();
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folderOf(target), error)) {
        const auto maker = makerOf(entry.path().filename().string(), name);
        if (!maker || (*maker != ::getpid() && runs(*maker)) || isLocked(entry.path()))
            continue;
        if (fs::remove(entry.path(), error))
            std::fprintf(stderr, "warning: removed %s, which a run that was killed left\n",
                         entry.path().c_str());
    }
}

}  // namespace hgmm::mrpt_bridge
