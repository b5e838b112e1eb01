#include "hgmm/evaluation/picture.h"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <stdexcept>

#include "hgmm/evaluation/metrics_json.h"

// PNG, second edition (ISO/IEC 15948): chunks, filters and colour types.
namespace hgmm::evaluation {
namespace {

void appendBigEndian(std::uint32_t value, std::string& out) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out += static_cast<char>((value >> shift) & 0xFFU);
}

void appendChunk(const std::string& type, const std::string& content, std::string& out) {
    appendBigEndian(static_cast<std::uint32_t>(content.size()), out);
    const std::string checked = type + content;
    out += checked;
    appendBigEndian(
        static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                                         static_cast<uInt>(checked.size()))),
        out);
}

std::string compressed(const std::string& bytes) {
    uLongf size = compressBound(bytes.size());
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                  Z_BEST_COMPRESSION) != Z_OK)
        throw std::runtime_error("a picture cannot be compressed");
    out.resize(size);
    return out;
}

/// Few colours take one byte for a pixel instead of three, which compresses far better.
struct Palette {
    std::string colours;  // RGB
    std::string pixels;   // index of each
};

std::optional<Palette> paletteOf(const Picture& picture) {
    constexpr std::size_t most = 256;
    std::map<std::uint32_t, char> indices;
    Palette palette;
    for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
        const std::uint8_t* p = &picture.rgb[i];
        const std::uint32_t colour = (std::uint32_t(p[0]) << 16U) |
                                     (std::uint32_t(p[1]) << 8U) | std::uint32_t(p[2]);
        const auto [entry, isNew] =
            indices.emplace(colour, static_cast<char>(indices.size()));
        if (indices.size() > most) return std::nullopt;
        if (isNew) palette.colours.append(reinterpret_cast<const char*>(p), 3);
        palette.pixels += entry->second;
    }
    return palette;
}

/// Rows of indices, as they are: neighbours in a palette have nothing in common.
std::string indexedRows(const Palette& palette, std::size_t width) {
    std::string rows;
    for (std::size_t i = 0; i < palette.pixels.size(); i += width)
        rows += '\0' + palette.pixels.substr(i, width);
    return rows;
}

/// Rows of differences from the row above (filter 2).
std::string filteredRows(const Picture& picture) {
    const std::size_t stride = 3 * static_cast<std::size_t>(picture.width_px);
    std::string rows;
    rows.reserve(picture.rgb.size() + static_cast<std::size_t>(picture.height_px));
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
        if (i % stride == 0) rows += '\2';
        const int above = i < stride ? 0 : picture.rgb[i - stride];
        rows += static_cast<char>(picture.rgb[i] - above);
    }
    return rows;
}

}  // namespace

std::string pngOf(const Picture& picture) {
    if (picture.width_px <= 0 || picture.height_px <= 0 ||
        picture.rgb.size() !=
            3 * static_cast<std::size_t>(picture.width_px) * picture.height_px)
        throw std::invalid_argument("a picture without pixels, or with too few or many");
    const std::optional<Palette> palette = paletteOf(picture);
    std::string header;
    appendBigEndian(static_cast<std::uint32_t>(picture.width_px), header);
    appendBigEndian(static_cast<std::uint32_t>(picture.height_px), header);
    header += '\10';                  // bits
    header += palette ? '\3' : '\2';  // colour type
    header += std::string(3, '\0');   // deflate, the usual filters, not interlaced
    std::string png = "\x89PNG\r\n\x1a\n";
    appendChunk("IHDR", header, png);
    if (palette) appendChunk("PLTE", palette->colours, png);
    appendChunk("IDAT",
                compressed(palette ? indexedRows(*palette,
                                                 static_cast<std::size_t>(picture.width_px))
                                   : filteredRows(picture)),
                png);
    appendChunk("IEND", "", png);
    return png;
}

void writePng(const Picture& picture, const std::string& file) {
    writeTextFile(file, pngOf(picture));
}

std::string base64(const std::string& bytes) {
    constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = (group << 8U) | (k < n ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += k <= n ? digits[(group >> (18U - 6U * k)) & 63U] : '=';
    }
    return out;
}

}  // namespace hgmm::evaluation
