#include "hgmm/mrpt_bridge/file_kind.h"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace hgmm::mrpt_bridge {
namespace {

bool startsWith(std::string_view text, std::string_view start) {
    return text.substr(0, start.size()) == start;
}

/// The name of the class that an MRPT archive starts with; empty if it is none.
std::string_view classOf(std::string_view start) {
    if (start.empty()) return {};
    const auto first = static_cast<unsigned char>(start[0]);
    const std::size_t length = first & 0x7FU;
    if (first < 0x80 || length == 0 || start.size() <= length) return {};
    const std::string_view name = start.substr(1, length);
    const bool isName = std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return (c >= '0' && c <= ':') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
               c == '_';
    });
    return isName ? name : std::string_view{};
}

FileKind kindOfClass(std::string_view name) {
    const std::size_t scope = name.rfind(':');
    const std::string_view own =
        scope == std::string_view::npos ? name : name.substr(scope + 1);
    if (own == "CHGMMOccupancyMap") return FileKind::map;
    if (own == "CSimpleMap") return FileKind::simpleMap;
    if (own == "COpenGLScene" || own == "Scene") return FileKind::scene;
    if (startsWith(own, "CObservation") || startsWith(own, "CAction") ||
        own == "CSensoryFrame" || own == "CRawlog")
        return FileKind::rawlog;
    return FileKind::other;
}

bool isText(std::string_view start) {
    return std::none_of(start.begin(), start.end(), [](unsigned char c) {
        return c == 0x7F || (c < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f');
    });
}

/// Of text, by the first line that is neither blank nor a comment.
FileKind kindOfText(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const std::size_t at = line.find_first_not_of(" \t\r");
        if (at == std::string_view::npos || line[at] == '#') continue;
        const std::string_view words = line.substr(at);
        if (words[0] == '{') return FileKind::json;
        if (startsWith(words, "<!DOCTYPE html") || startsWith(words, "<html"))
            return FileKind::html;
        if (startsWith(words, "<svg")) return FileKind::svg;
        if (startsWith(words, "image:")) return FileKind::slice;
        const bool isNumber =
            words.find_first_not_of("0123456789+-.,eE \t\r") == std::string_view::npos;
        return isNumber ? FileKind::numbers : FileKind::text;
    }
    return FileKind::text;
}

}  // namespace

FileKind kindOf(std::string_view start) {
    start = start.substr(0, kKindBytes);
    if (start.empty()) return FileKind::empty;
    if (const std::string_view name = classOf(start); !name.empty())
        return kindOfClass(name);
    if (startsWith(start, "# Octomap OcTree")) return FileKind::octree;
    if (startsWith(start, "ply\n") || startsWith(start, "ply\r")) return FileKind::ply;
    if (startsWith(start, "\x89PNG")) return FileKind::png;
    if (startsWith(start, "P5")) return FileKind::pgm;
    if (startsWith(start, "glTF")) return FileKind::gltf;
    return isText(start) ? kindOfText(start) : FileKind::other;
}

FileKind kindOfFile(const std::string& file) {
    const gzFile stream = gzopen(file.c_str(), "rb");  // reads what is not compressed, too
    if (stream == nullptr) return FileKind::other;
    std::array<char, kKindBytes> start{};
    const int size = gzread(stream, start.data(), start.size());
    const bool isCompressed = gzdirect(stream) == 0;
    gzclose_r(stream);
    if (size < 0 || (size == 0 && isCompressed)) return FileKind::other;
    return kindOf({start.data(), static_cast<std::size_t>(size)});
}

const char* nameOf(FileKind kind) {
    switch (kind) {
        case FileKind::empty:
            return "empty";
        case FileKind::map:
            return "a map";
        case FileKind::rawlog:
            return "a rawlog";
        case FileKind::simpleMap:
            return "a simple map";
        case FileKind::scene:
            return "a 3D scene";
        case FileKind::octree:
            return "an octree";
        case FileKind::ply:
            return "a PLY file";
        case FileKind::png:
            return "a PNG picture";
        case FileKind::pgm:
            return "a PGM picture";
        case FileKind::gltf:
            return "a glTF scene";
        case FileKind::slice:
            return "a slice's description";
        case FileKind::json:
            return "a JSON file";
        case FileKind::html:
            return "an HTML page";
        case FileKind::svg:
            return "an SVG picture";
        case FileKind::numbers:
            return "a file of numbers";
        case FileKind::text:
            return "a text";
        case FileKind::other:
            break;
    }
    return "of a kind that is not known";
}

}  // namespace hgmm::mrpt_bridge
