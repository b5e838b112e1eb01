#include "hgmm/mrpt_bridge/gzip_output.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace hgmm::mrpt_bridge {

GzipOutput::GzipOutput(OutputFile& file) : file_(file) {
    const int descriptor = file.duplicateDescriptor();
    stream_ = gzdopen(descriptor, "wb1");
    if (stream_ == nullptr) {
        ::close(descriptor);
        file_.failToWrite("no memory");
    }
}

GzipOutput::~GzipOutput() {
    if (stream_ != nullptr) gzclose_w(stream_);
}

void GzipOutput::fail(int error) const {
    file_.failToWrite(error == Z_ERRNO ? std::strerror(errno) : "compression failed");
}

void GzipOutput::write(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream content;
    mrpt::serialization::archiveFrom(content) << object;
    const char* at = static_cast<const char*>(content.getRawBufferData());
    constexpr std::uint64_t most = std::uint64_t{1} << 30U;
    for (std::uint64_t left = content.getTotalBytesCount(); left > 0;) {
        const auto step = static_cast<unsigned>(std::min(left, most));
        if (gzwrite(stream_, at, step) != static_cast<int>(step)) {
            const int cause = errno;
            int error = Z_OK;
            gzerror(stream_, &error);
            errno = cause;
            fail(error);
        }
        at += step;
        left -= step;
    }
}

void GzipOutput::close() {
    const int error = gzclose_w(stream_);
    stream_ = nullptr;
    if (error != Z_OK) fail(error);
}

}  // namespace hgmm::mrpt_bridge
