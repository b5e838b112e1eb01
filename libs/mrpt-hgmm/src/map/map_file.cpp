#include <mrpt/core/exceptions.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "map/map_archive.h"

namespace fs = std::filesystem;
using mrpt::maps::CHGMMOccupancyMap;

namespace hgmm::mrpt_bridge {

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& what) {
    throw std::runtime_error(file + ": " + what);
}

/// Whether a text was written for users: MRPT's own texts name source files and functions,
/// and names in damaged content hold any bytes.
bool isPlain(const std::string& text) {
    for (const char* code : {"::", ".h:", ".cpp:"})
        if (text.find(code) != std::string::npos) return false;
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return c >= ' ' && c < 0x7F;
    });
}

/// The first line of what was said; MRPT's exceptions carry a call stack behind it.
std::string cause(const std::exception& e) {
    const auto* traced = dynamic_cast<const mrpt::ExceptionWithCallBackBase*>(&e);
    const std::string text = traced ? traced->originalWhat : e.what();
    const std::string line = text.substr(0, text.find('\n'));
    return isPlain(line) ? line : "its content is damaged, or no map";
}

/// Whether a file starts as gzip does and ends with the length of its content. The stream
/// that MRPT reads through accepts any file, and one that lost its end.
bool isWholeGzip(const std::string& fileName, std::uint64_t contentSize) {
    std::ifstream file(fileName, std::ios::binary);
    std::array<unsigned char, 4> bytes{};
    const auto read4 = [&] {
        return bool(file.read(reinterpret_cast<char*>(bytes.data()), bytes.size()));
    };
    if (!read4() || bytes[0] != 0x1F || bytes[1] != 0x8B) return false;
    if (!file.seekg(-4, std::ios::end) || !read4()) return false;
    std::uint32_t size = 0;
    for (int i = 3; i >= 0; --i) size = size << 8U | bytes[i];
    return size == static_cast<std::uint32_t>(contentSize);
}

/// The content of a gz file, read to its end so that its check sum has been verified.
std::vector<std::uint8_t> readGzip(const std::string& fileName) {
    if (!fs::is_regular_file(fileName))
        fail(fileName,
             fs::exists(fileName)
                 ? "not a file"
                 : "no such file (working folder: " + fs::current_path().string() + ")");
    mrpt::io::CFileGZInputStream stream;
    std::string why;
    if (!stream.open(fileName, why)) fail(fileName, "cannot be opened: " + why);
    constexpr std::size_t step = std::size_t{1} << 20U;
    std::vector<std::uint8_t> content;
    for (;;) {
        const std::size_t begin = content.size();
        content.resize(begin + step);
        const std::size_t got = stream.Read(content.data() + begin, step);
        if (got > step) fail(fileName, "not a saved map, or damaged (gzip)");
        content.resize(begin + got);
        if (got == 0) break;
    }
    if (!isWholeGzip(fileName, content.size()))
        fail(fileName, "not a saved map, or it lost its end");
    return content;
}

}  // namespace

void saveMapFile(const CHGMMOccupancyMap& map, const std::string& fileName,
                 Replace replace) {
    OutputFile file({fileName, FileKind::map}, replace);
    writeObject(file, map);
    file.commit();
}

CHGMMOccupancyMap loadMapFile(const std::string& fileName) {
    const std::vector<std::uint8_t> bytes = readGzip(fileName);
    mrpt::io::CMemoryStream content;
    content.assignMemoryNotOwn(bytes.data(), bytes.size());
    mrpt::serialization::CSerializable::Ptr object;
    try {
        object = mrpt::serialization::archiveFrom(content).ReadObject();
    } catch (const std::exception& e) {
        fail(fileName, "not a map that can be read: " + cause(e));
    }
    const auto map = std::dynamic_pointer_cast<CHGMMOccupancyMap>(object);
    if (!map)
        fail(fileName, std::string("holds a ") +
                           (object ? object->GetRuntimeClass()->className : "null object") +
                           ", not a mrpt::maps::CHGMMOccupancyMap");
    return *map;
}

}  // namespace hgmm::mrpt_bridge
