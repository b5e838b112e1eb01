#include "hgmm/mrpt_bridge/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <list>
#include <set>

#include "files/output_target.h"
#include "hgmm/mrpt_bridge/gzip_output.h"

namespace hgmm::mrpt_bridge {
namespace {

/// What other systems of files do not sync, they keep in another way: no error.
void syncFolder(const std::string& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

/// Keeps the files that a rename replaces until all renames have succeeded.
class Replaced {
 public:
    ~Replaced() {
        for (const Step& step : steps_)
            if (!step.former.empty()) ::unlink(step.former.c_str());
    }
    Replaced() = default;
    Replaced(const Replaced&) = delete;
    Replaced& operator=(const Replaced&) = delete;

    /// Renames; false, with errno, if that failed.
    bool rename(const std::string& from, const std::string& to) {
        const std::string former = from + "-former";
        const bool isKept = ::link(to.c_str(), former.c_str()) == 0;
        if (::rename(from.c_str(), to.c_str()) == 0) {
            steps_.push_back({to, isKept ? former : std::string()});
            return true;
        }
        const int cause = errno;
        if (isKept) ::unlink(former.c_str());
        errno = cause;
        return false;
    }
    void undo() {
        for (Step& step : steps_) {
            // Where this fails the former file keeps its other name: nothing is lost.
            if (step.former.empty())
                static_cast<void>(::unlink(step.name.c_str()));
            else
                static_cast<void>(::rename(step.former.c_str(), step.name.c_str()));
            step.former.clear();
        }
    }

 private:
    struct Step {
        std::string name, former;
    };
    std::vector<Step> steps_;
};

}  // namespace

OutputFile::OutputFile(const Output& output, Replace replace) : name_(output.file) {
    checkOutputs({output}, {}, replace);
    const OutputTarget target = targetOf(name_);
    target_ = target.file;
    if (target.isDirect) {
        descriptor_ = ::open(target_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
        if (descriptor_ < 0)
            failOutput(name_, std::string("cannot be written: ") + std::strerror(errno));
        return;
    }
    removeLeftovers(target_);
    openTemporary();
}

OutputFile::~OutputFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::openTemporary() {
    const std::string name = target_ + ".part" + std::to_string(::getpid());
    constexpr int mostThreads = 1000;  // of this process that write the same file
    for (int i = 0; i < mostThreads && descriptor_ < 0; ++i) {
        temporary_ = i == 0 ? name : name + "-" + std::to_string(i);
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                             S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH);
        if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) {
        temporary_.clear();
        failOutput(name_, std::string("cannot be written: ") + std::strerror(errno));
    }
    ::flock(descriptor_, LOCK_EX | LOCK_NB);  // tells others that it is no leftover
    struct stat former {};
    constexpr mode_t permissions = 0777;
    if (::stat(target_.c_str(), &former) == 0)
        ::fchmod(descriptor_, former.st_mode & permissions);
}

void OutputFile::failToWrite(const std::string& cause) const {
    failOutput(name_, "could not be written to its end: " + cause);
}

void OutputFile::write(const void* data, std::size_t size) {
    const char* at = static_cast<const char*>(data);
    constexpr std::size_t most = std::size_t{1} << 30U;
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, at, std::min(size, most));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) failToWrite(std::strerror(errno));
        at += written;
        size -= static_cast<std::size_t>(written);
    }
}

int OutputFile::duplicateDescriptor() const {
    const int copy = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
    if (copy < 0) failToWrite(std::strerror(errno));
    return copy;
}

void OutputFile::sync() {
    if (!temporary_.empty() && ::fsync(descriptor_) != 0) failToWrite(std::strerror(errno));
}

void OutputFile::commitAll(const std::vector<OutputFile*>& files) {
    for (OutputFile* file : files) file->sync();
    Replaced replaced;
    for (OutputFile* file : files) {
        if (file->temporary_.empty()) continue;
        if (replaced.rename(file->temporary_, file->target_)) continue;
        const std::string cause = std::strerror(errno);
        replaced.undo();
        file->failToWrite(cause);
    }
    std::set<std::string> folders;
    for (OutputFile* file : files) {
        if (!file->temporary_.empty()) folders.insert(folderOf(file->target_));
        file->temporary_.clear();
    }
    for (const std::string& folder : folders) syncFolder(folder);
}

void writeFiles(const std::vector<FileContent>& contents, Replace replace) {
    std::list<OutputFile> outputs;
    std::vector<OutputFile*> all;
    for (const auto& [file, content] : contents) {
        all.push_back(&outputs.emplace_back(Output{file, kindOf(content)}, replace));
        all.back()->write(content.data(), content.size());
    }
    OutputFile::commitAll(all);
}

void writeFile(const std::string& file, std::string_view content, Replace replace) {
    writeFiles({{file, content}}, replace);
}

void writeObject(OutputFile& file, const mrpt::serialization::CSerializable& object) {
    GzipOutput stream(file);
    stream.write(object);
    stream.close();
}

}  // namespace hgmm::mrpt_bridge
