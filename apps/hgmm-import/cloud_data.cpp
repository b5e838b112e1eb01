#include "cloud_data.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>

#include "cloud_fields.h"

namespace hgmm::importer {
namespace {

template <typename T>
T loadAs(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

double loadNumber(const char* bytes, const CloudField& field) {
    if (field.type == 'F')
        return field.size == 4 ? loadAs<float>(bytes) : loadAs<double>(bytes);
    const bool isSigned = field.type == 'I';
    switch (field.size) {
        case 1:
            return isSigned ? loadAs<std::int8_t>(bytes) : loadAs<std::uint8_t>(bytes);
        case 2:
            return isSigned ? loadAs<std::int16_t>(bytes) : loadAs<std::uint16_t>(bytes);
        case 4:
            return isSigned ? loadAs<std::int32_t>(bytes) : loadAs<std::uint32_t>(bytes);
        default:
            return isSigned ? static_cast<double>(loadAs<std::int64_t>(bytes))
                            : static_cast<double>(loadAs<std::uint64_t>(bytes));
    }
}

/// Next word of a text as a number; nothing at the end of the text.
std::optional<double> nextNumber(const char*& text) {
    text += std::strspn(text, " \t\r\n");
    if (*text == '\0') return std::nullopt;
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text || (*end != '\0' && !std::strchr(" \t\r\n", *end)))
        throw std::runtime_error("'" + std::string(text, std::strcspn(text, " \t\r\n")) +
                                 "' is not a number");
    text = end;
    return value;
}

/// PCL writes colours as the float or the integer that has their bits. Others write the
/// integer though the field is said to be a float, which no colour's float could be: with
/// an alpha of 0 it is tiny, with 255 negative or NaN.
std::uint32_t colorBits(double value, const CloudField& field) {
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    const bool isInteger =
        value == 0 || (value >= 1 && value <= most && value == std::floor(value));
    if (field.type == 'F' && !isInteger) {
        const auto asFloat = static_cast<float>(value);
        return loadAs<std::uint32_t>(reinterpret_cast<const char*>(&asFloat));
    }
    if (!(value >= std::numeric_limits<std::int32_t>::min() && value <= most))
        throw std::runtime_error("the colour " + std::to_string(value) +
                                 " is out of range");
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
}

}  // namespace

void requireBytes(std::size_t announced, std::size_t available, const char* what) {
    if (available < announced)
        throw std::runtime_error("is truncated: its header announces " +
                                 std::to_string(announced) + " " + what + ", there are " +
                                 std::to_string(available) +
                                 "; fetch or unpack the file again");
}

std::size_t readAsciiPoints(const CloudLayout& layout, const std::string& bytes,
                            std::size_t offset, RecordedCloud& cloud) {
    const CloudFields fields(layout);
    const char* text = bytes.c_str() + offset;
    std::vector<double> row(layout.columns);
    for (std::size_t i = 0; i < layout.points; ++i) {
        for (double& value : row) {
            const auto number = nextNumber(text);
            if (!number) requireBytes(layout.points, i, "points");
            value = *number;
        }
        cloud.points.push_back(
            fields.build([&](const CloudField& f) { return row[f.column]; },
                         [&](const CloudField& f) { return colorBits(row[f.column], f); }));
    }
    return static_cast<std::size_t>(text - bytes.c_str());
}

void readBinaryPoints(const CloudLayout& layout, const char* data, BinaryOrder order,
                      RecordedCloud& cloud) {
    const CloudFields fields(layout);
    cloud.points.reserve(layout.points);
    for (std::size_t i = 0; i < layout.points; ++i) {
        const auto at = [&](const CloudField& f) {
            return order == BinaryOrder::columns
                       ? data + f.offset * layout.points + i * f.size
                       : data + i * layout.stride + f.offset;
        };
        cloud.points.push_back(fields.build(
            [&](const CloudField& f) { return loadNumber(at(f), f); },
            [&](const CloudField& f) { return loadAs<std::uint32_t>(at(f)); }));
    }
}

}  // namespace hgmm::importer
