#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "hgmm/mrpt_bridge/file_kind.h"

namespace mrpt::serialization {
class CSerializable;
}

/// All files that the plugin and the programs write go through OutputFile.
namespace hgmm::mrpt_bridge {

/// Which files an output may replace.
enum class Replace { sameKind, anyKind };

/// An output of a program, as the command line names it.
struct Output {
    std::string file;  ///< empty: none
    FileKind kind = FileKind::text;
};

/// Throws std::runtime_error, in one sentence that names the file, if an output cannot be
/// written or would replace what it must not: one of the inputs (also through links), a
/// folder, a block device, a socket, a file that is write-protected or, for
/// Replace::sameKind, one of another kind. Looks at all before anything is written.
void checkOutputs(const std::vector<Output>& outputs,
                  const std::vector<std::string>& inputs,
                  Replace replace = Replace::sameKind);

/// A file that appears under its name only when it is whole. Until commit() it is
/// NAME.partPID in the same folder, which is removed if this object dies first. A symbolic
/// link stays, and what it names is replaced. Character devices and pipes are written
/// directly. Leftovers of processes that were killed are removed, with a warning.
class OutputFile {
 public:
    /// Throws as checkOutputs does.
    OutputFile(const Output& output, Replace replace = Replace::sameKind);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Throws std::runtime_error if not all was written.
    void write(const void* data, std::size_t size);
    /// A descriptor of its own to the same place; the caller closes it.
    int duplicateDescriptor() const;
    /// Throws std::runtime_error "NAME: could not be written to its end: CAUSE".
    [[noreturn]] void failToWrite(const std::string& cause) const;

    /// Puts the file in its place. Throws std::runtime_error.
    void commit() { commitAll({this}); }
    /// Puts all in their places, or none if one fails. First all are on the disk, then all
    /// are renamed, in this order.
    static void commitAll(const std::vector<OutputFile*>& files);

 private:
    void openTemporary();
    void sync();

    std::string name_;       // as the user has it
    std::string target_;     // where its symbolic links lead to
    std::string temporary_;  // empty: written directly, or committed
    int descriptor_ = -1;
};

/// What a file is to hold.
struct FileContent {
    std::string file;
    std::string_view content;  ///< tells the kind
};

/// Writes files, all or none.
void writeFiles(const std::vector<FileContent>& contents,
                Replace replace = Replace::sameKind);
/// Writes one file, whole or not at all.
void writeFile(const std::string& file, std::string_view content,
               Replace replace = Replace::sameKind);

/// Writes an MRPT object as MRPT's saveToFile functions do: gzip-compressed. Leaves the
/// commit to the caller.
void writeObject(OutputFile& file, const mrpt::serialization::CSerializable& object);

}  // namespace hgmm::mrpt_bridge
