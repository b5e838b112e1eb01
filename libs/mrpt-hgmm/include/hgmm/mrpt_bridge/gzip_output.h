#pragma once
#include <mrpt/serialization/CSerializable.h>

#include "hgmm/mrpt_bridge/output_file.h"

struct gzFile_s;

namespace hgmm::mrpt_bridge {

/// A gzip stream of MRPT objects into an output file.
class GzipOutput {
 public:
    /// The file must live longer.
    explicit GzipOutput(OutputFile& file);
    ~GzipOutput();
    GzipOutput(const GzipOutput&) = delete;
    GzipOutput& operator=(const GzipOutput&) = delete;

    /// Throws std::runtime_error if it could not be written.
    void write(const mrpt::serialization::CSerializable& object);
    /// Ends the stream, so that the file can be committed. Throws as write does.
    void close();

 private:
    [[noreturn]] void fail(int error) const;

    OutputFile& file_;
    gzFile_s* stream_;
};

}  // namespace hgmm::mrpt_bridge
