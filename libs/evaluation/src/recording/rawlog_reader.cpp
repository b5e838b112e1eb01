#include "hgmm/evaluation/rawlog_reader.h"

#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

struct GzCloser {
    void operator()(gzFile_s* f) const { gzclose_r(f); }
};
using GzFile = std::unique_ptr<gzFile_s, GzCloser>;

/// Reads a (possibly compressed) file up to `limit` uncompressed bytes. Returns the stream,
/// or null if the file cannot be opened; `complete` says whether there was no error on the
/// way.
GzFile readUpTo(const std::string& file, std::uint64_t limit, bool& complete) {
    GzFile gz(gzopen(file.c_str(), "rb"));
    complete = gz != nullptr;
    std::array<char, 1U << 16U> buffer{};
    for (std::uint64_t left = limit; gz && left > 0;) {
        const int n =
            gzread(gz.get(), buffer.data(),
                   static_cast<unsigned>(std::min<std::uint64_t>(left, buffer.size())));
        int error = Z_OK;
        gzerror(gz.get(), &error);
        // A compressed file that stops early is an error only once it has been read to its
        // end.
        if (n < 0 || error != Z_OK) complete = false;
        if (n <= 0) break;
        left -= static_cast<std::uint64_t>(n);
    }
    return gz;
}

/// The part of an MRPT exception that says what happened: its innermost message, on one
/// line.
std::string innermostMessage(const std::string& what) {
    static const std::string tag = "Message:";
    const std::size_t at = what.rfind(tag);
    if (at == std::string::npos) return what.substr(0, what.find('\n'));
    const std::size_t start = what.find_first_not_of(" \n", at + tag.size());
    if (start == std::string::npos) return "unreadable object";
    return what.substr(start, what.find('\n', start) - start);
}

}  // namespace

RawlogReader::RawlogReader(const std::string& file) : file_(file) {
    std::error_code error;
    const bool regular = std::filesystem::is_regular_file(file, error);
    if (!regular || error)
        throw std::runtime_error(file +
                                 ": there is no such file; give the path of a .rawlog");
    if (std::filesystem::file_size(file) == 0)
        throw std::runtime_error(file + ": the file is empty; record or import it again");
    if (!stream_.open(file)) throw std::runtime_error(file + ": the file cannot be read");
}

mrpt::serialization::CSerializable::Ptr RawlogReader::next() {
    if (!damage_.empty()) return nullptr;
    try {
        auto archive = mrpt::serialization::archiveFrom(stream_);
        mrpt::serialization::CSerializable::Ptr entry = archive.ReadObject();
        ++entries_;
        endOfLastEntry_ = stream_.getPosition();
        return entry;
    } catch (const mrpt::serialization::CExceptionEOF&) {
        bool complete = false;
        readUpTo(file_, endOfLastEntry_ + 1, complete);
        if (!complete) describeDamage("the compressed data stops early");
    } catch (const std::exception& e) {
        describeDamage(innermostMessage(e.what()));
    }
    return nullptr;
}

void RawlogReader::describeDamage(const std::string& cause) {
    const std::uint64_t total = std::filesystem::file_size(file_);
    bool complete = false;
    const GzFile gz = readUpTo(file_, endOfLastEntry_, complete);
    const auto used = gz ? static_cast<std::uint64_t>(gzoffset(gz.get())) : 0;
    damage_ = file_ + ": damaged after " + std::to_string(entries_) +
              " whole entries; the last " + std::to_string(total - std::min(used, total)) +
              " of its " + std::to_string(total) + " bytes are lost (" + cause + ")";
}

}  // namespace hgmm::evaluation
