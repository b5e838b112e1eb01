#include "ply_reader.h"

#include <hgmm/evaluation/parse_numbers.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include "cloud_data.h"
#include "cloud_fields.h"
#include "files.h"

namespace hgmm::importer {
namespace {

/// The elements up to and with the vertices, and where the data begins.
struct PlyHeader {
    std::string format;
    CloudLayout before;  ///< points: elements before the vertices, all of one kind
    CloudLayout vertices;
    std::size_t dataOffset = 0;
};

CloudField fieldOf(const std::string& type, const std::string& name) {
    static const std::map<std::string, std::pair<char, std::size_t>> types{
        {"char", {'I', 1}},   {"int8", {'I', 1}},    {"uchar", {'U', 1}},
        {"uint8", {'U', 1}},  {"short", {'I', 2}},   {"int16", {'I', 2}},
        {"ushort", {'U', 2}}, {"uint16", {'U', 2}},  {"int", {'I', 4}},
        {"int32", {'I', 4}},  {"uint", {'U', 4}},    {"uint32", {'U', 4}},
        {"float", {'F', 4}},  {"float32", {'F', 4}}, {"double", {'F', 8}},
        {"float64", {'F', 8}}};
    const auto known = types.find(type);
    if (known == types.end() || name.empty())
        throw std::runtime_error("the header's property " + name +
                                 " has the unknown type '" + type + "'");
    CloudField field;
    field.name = name;
    std::tie(field.type, field.size) = known->second;
    return field;
}

std::size_t countOf(const std::string& word) {
    constexpr double mostPoints = 1e10;
    const auto numbers = evaluation::parseNumbers(word);
    if (numbers.size() != 1 || numbers[0] < 0 || numbers[0] > mostPoints)
        throw std::runtime_error("'" + word + "' in the header is no count");
    return static_cast<std::size_t>(numbers[0]);
}

/// Takes in the lines of the header, one after the other.
class HeaderParser {
 public:
    void take(const std::string& line) {
        std::istringstream words(line);
        std::string key, a, b;
        words >> key >> a >> b;
        if (key == "format") header_.format = a;
        if (key == "element") startElement(a, b);
        if (key == "property") addProperty(a, b);
    }
    PlyHeader finish(std::size_t dataOffset) {
        const auto& format = header_.format;
        if (format != "ascii" && format != "binary_little_endian" &&
            format != "binary_big_endian")
            throw std::runtime_error("its format '" + format +
                                     "' is not ascii, binary_little_endian or "
                                     "binary_big_endian");
        if (!hasVertices_) throw std::runtime_error("has no element vertex");
        header_.dataOffset = dataOffset;
        return header_;
    }

 private:
    void startElement(const std::string& name, const std::string& count) {
        if (name == "vertex") {
            hasVertices_ = true;
            header_.vertices.points = countOf(count);
            current_ = &header_.vertices;
        } else if (hasVertices_) {
            current_ = nullptr;
        } else if (current_) {
            throw std::runtime_error("has more than one element before the vertices");
        } else {
            header_.before.points = countOf(count);
            current_ = &header_.before;
        }
    }
    void addProperty(const std::string& type, const std::string& name) {
        if (!current_) return;
        if (type == "list")
            throw std::runtime_error(
                "has a list among or before its vertices; write it with vertices first");
        current_->add(fieldOf(type, name));
    }

    PlyHeader header_;
    CloudLayout* current_ = nullptr;
    bool hasVertices_ = false;
};

PlyHeader parseHeader(const std::string& bytes) {
    HeaderParser parser;
    std::size_t begin = 0;
    for (bool first = true;; first = false) {
        const std::size_t end = bytes.find('\n', begin);
        std::string line = bytes.substr(begin, end - begin);
        line.erase(line.find_last_not_of(" \t\r") + 1);
        if (first && line != "ply") throw std::runtime_error("is no PLY file");
        if (end == std::string::npos)
            throw std::runtime_error("is no PLY file: its header has no end_header");
        begin = end + 1;
        if (line == "end_header") return parser.finish(begin);
        parser.take(line);
    }
}

/// Turns the bytes of each number around.
void swapBytes(const CloudLayout& layout, std::string& data) {
    for (std::size_t i = 0; i < layout.points; ++i)
        for (const auto& field : layout.fields) {
            const auto at =
                data.begin() + static_cast<long>(i * layout.stride + field.offset);
            std::reverse(at, at + static_cast<long>(field.size));
        }
}

/// Where the vertices begin in a text: behind as many lines as there are elements before.
std::size_t afterLines(const std::string& bytes, std::size_t offset, std::size_t lines) {
    for (std::size_t i = 0; i < lines; ++i) {
        const std::size_t end = bytes.find('\n', offset);
        if (end == std::string::npos) requireBytes(lines, i, "elements");
        offset = end + 1;
    }
    return offset;
}

RecordedCloud parsePly(const std::string& bytes) {
    const PlyHeader header = parseHeader(bytes);
    const CloudLayout& layout = header.vertices;
    RecordedCloud cloud = CloudFields(layout).emptyCloud();
    if (header.format == "ascii") {
        readAsciiPoints(layout, bytes,
                        afterLines(bytes, header.dataOffset, header.before.points), cloud);
        return cloud;
    }
    const std::size_t skipped = header.before.points * header.before.stride;
    const std::size_t needed = layout.points * layout.stride;
    requireBytes(skipped + needed, bytes.size() - header.dataOffset, "bytes of data");
    std::string data = bytes.substr(header.dataOffset + skipped, needed);
    if (header.format == "binary_big_endian") swapBytes(layout, data);
    readBinaryPoints(layout, data.data(), BinaryOrder::points, cloud);
    return cloud;
}

}  // namespace

RecordedCloud readPly(const std::string& file) {
    const std::string bytes = readBytes(file);
    try {
        return parsePly(bytes);
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
}

}  // namespace hgmm::importer
