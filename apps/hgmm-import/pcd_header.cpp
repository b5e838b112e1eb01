#include "pcd_header.h"

#include <hgmm/evaluation/parse_numbers.h>

#include <map>
#include <sstream>
#include <stdexcept>

namespace hgmm::importer {
namespace {

using Entries = std::map<std::string, std::string>;

// Bounds that keep points times stride within 64 bits, far above what any file holds.
constexpr double kMostPoints = 1e10;
constexpr std::size_t kMostColumns = 1000000;

/// Splits the header into keyword and rest of line, up to and with DATA.
Entries readEntries(const std::string& bytes, std::size_t& dataOffset) {
    Entries entries;
    std::size_t begin = 0;
    while (entries.count("DATA") == 0) {
        const std::size_t end = bytes.find('\n', begin);
        if (end == std::string::npos)
            throw std::runtime_error("is no PCD file: its header has no DATA line");
        std::istringstream line(bytes.substr(begin, end - begin));
        std::string key, rest;
        line >> key;
        std::getline(line >> std::ws, rest);
        rest.erase(rest.find_last_not_of(" \t\r") + 1);
        if (!key.empty() && key[0] != '#') entries[key] = rest;
        begin = end + 1;
    }
    dataOffset = begin;
    return entries;
}

std::vector<std::string> words(const Entries& entries, const std::string& key) {
    const auto entry = entries.find(key);
    if (entry == entries.end())
        throw std::runtime_error("the header has no " + key + " line");
    std::istringstream in(entry->second);
    std::vector<std::string> result;
    for (std::string word; in >> word;) result.push_back(word);
    return result;
}

std::size_t toCount(const std::string& word, const std::string& key) {
    const auto numbers = evaluation::parseNumbers(word);
    if (numbers.size() != 1 || numbers[0] < 0 || numbers[0] > kMostPoints ||
        numbers[0] != static_cast<double>(static_cast<std::size_t>(numbers[0])))
        throw std::runtime_error("'" + word + "' in the header's " + key +
                                 " line is no count");
    return static_cast<std::size_t>(numbers[0]);
}

std::size_t oneCount(const Entries& entries, const std::string& key) {
    const auto values = words(entries, key);
    if (values.size() != 1)
        throw std::runtime_error("the header's " + key + " line needs 1 number");
    return toCount(values[0], key);
}

std::size_t readPointCount(const Entries& entries) {
    if (entries.count("POINTS")) return oneCount(entries, "POINTS");
    const std::size_t width = oneCount(entries, "WIDTH");
    const std::size_t height = oneCount(entries, "HEIGHT");
    if (static_cast<double>(width) * static_cast<double>(height) > kMostPoints)
        throw std::runtime_error("the header's WIDTH and HEIGHT are no counts");
    return width * height;
}

void requireKnownType(const CloudField& field) {
    const bool isFloat = field.type == 'F' && (field.size == 4 || field.size == 8);
    const bool isInteger =
        (field.type == 'I' || field.type == 'U') &&
        (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8);
    if (!isFloat && !isInteger)
        throw std::runtime_error("the header's field " + field.name +
                                 " has the unknown type " + field.type +
                                 std::to_string(field.size));
}

void readFields(const Entries& entries, CloudLayout& layout) {
    const auto names = words(entries, "FIELDS");
    const auto sizes = words(entries, "SIZE");
    const auto types = words(entries, "TYPE");
    const auto counts = entries.count("COUNT")
                            ? words(entries, "COUNT")
                            : std::vector<std::string>(names.size(), "1");
    if (sizes.size() != names.size() || types.size() != names.size() ||
        counts.size() != names.size())
        throw std::runtime_error(
            "the header's FIELDS, SIZE, TYPE and COUNT differ in length");
    for (std::size_t i = 0; i < names.size(); ++i) {
        CloudField field;
        field.name = names[i];
        field.type = types[i][0];
        field.size = toCount(sizes[i], "SIZE");
        field.count = toCount(counts[i], "COUNT");
        requireKnownType(field);
        if (field.count > kMostColumns)
            throw std::runtime_error("the header announces more than a million columns");
        layout.add(field);
        if (layout.columns > kMostColumns)
            throw std::runtime_error("the header announces more than a million columns");
    }
}

}  // namespace

PcdHeader parsePcdHeader(const std::string& bytes) {
    PcdHeader header;
    const Entries entries = readEntries(bytes, header.dataOffset);
    readFields(entries, header.layout);
    header.layout.points = readPointCount(entries);
    header.data = entries.at("DATA");
    if (header.data != "ascii" && header.data != "binary" &&
        header.data != "binary_compressed")
        throw std::runtime_error("DATA is '" + header.data +
                                 "'; only ascii, binary and binary_compressed can be read");
    if (entries.count("VIEWPOINT")) {
        const auto numbers = evaluation::parseNumbers(entries.at("VIEWPOINT"));
        if (numbers.size() < 3)
            throw std::runtime_error("the header's VIEWPOINT line needs 3 or 7 numbers");
        header.viewpoint = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
    }
    return header;
}

}  // namespace hgmm::importer
