#include "map_file.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "hgmm/map.h"

namespace fs = std::filesystem;

namespace hgmm::python {

namespace {

constexpr int kGzip = 16 + MAX_WBITS;                 // zlib: a gzip header and trailer
constexpr std::size_t kStep = std::size_t{1} << 24U;  // what zlib is given at once [bytes]

[[noreturn]] void fail(const std::string& what, const fs::path& file) {
    throw fs::filesystem_error(what, file, {errno ? errno : EIO, std::generic_category()});
}

/// Feeds zlib all bytes and gathers what it makes of them, until it reports an end or an
/// error.
/// @return its last report
template <typename Step>
int run(z_stream& stream, const std::vector<std::uint8_t>& in,
        std::vector<std::uint8_t>& out, Step&& step) {
    int report = Z_OK;
    std::size_t taken = 0, made = 0;
    stream.next_in = const_cast<Bytef*>(in.data());
    while (report == Z_OK) {
        if (made == out.size()) out.resize(std::max<std::size_t>(4096, 2 * made));
        const auto feed = static_cast<uInt>(std::min(kStep, in.size() - taken));
        const auto room = static_cast<uInt>(std::min(kStep, out.size() - made));
        stream.avail_in = feed;
        stream.next_out = out.data() + made;
        stream.avail_out = room;
        report = step(taken + feed == in.size());
        taken += feed - stream.avail_in;
        made += room - stream.avail_out;
    }
    out.resize(made);
    return taken == in.size() ? report : Z_DATA_ERROR;
}

}  // namespace

std::vector<std::uint8_t> readFile(const fs::path& file) {
    errno = 0;
    if (fs::is_directory(file)) {
        errno = EISDIR;
        fail("cannot be read", file);
    }
    std::ifstream in(file, std::ios::binary);
    if (!in) fail("cannot be read", file);
    std::vector<std::uint8_t> bytes(fs::file_size(file));
    in.read(reinterpret_cast<char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
    if (!in) fail("cannot be read", file);
    return bytes;
}

void writeFile(const fs::path& file, const std::vector<std::uint8_t>& bytes) {
    const fs::path part = file.string() + ".part" + std::to_string(::getpid());
    errno = 0;
    std::ofstream out(part, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    out.close();
    std::error_code renamed;
    if (out) fs::rename(part, file, renamed);
    if (out && !renamed) return;
    if (renamed) errno = renamed.value();
    const int why = errno;
    std::error_code ignored;
    fs::remove(part, ignored);
    errno = why;
    fail("cannot be written", file);
}

bool isGzip(const std::vector<std::uint8_t>& bytes) {
    return bytes.size() > 2 && bytes[0] == 0x1F && bytes[1] == 0x8B;
}

std::vector<std::uint8_t> gunzipped(const std::vector<std::uint8_t>& bytes) {
    z_stream stream{};
    if (inflateInit2(&stream, kGzip) != Z_OK) throw std::bad_alloc();
    std::vector<std::uint8_t> content;
    const int report =
        run(stream, bytes, content, [&](bool) { return inflate(&stream, Z_NO_FLUSH); });
    inflateEnd(&stream);
    if (report != Z_STREAM_END)
        throw FormatError("not a saved map, damaged, or it lost its end");
    return content;
}

std::vector<std::uint8_t> gzipped(const std::vector<std::uint8_t>& bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, 1, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    std::vector<std::uint8_t> content;
    run(stream, bytes, content,
        [&](bool isLast) { return deflate(&stream, isLast ? Z_FINISH : Z_NO_FLUSH); });
    deflateEnd(&stream);
    return content;
}

}  // namespace hgmm::python
