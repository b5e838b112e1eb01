#include "pcd_reader.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "files.h"
#include "lzf.h"
#include "pcd_header.h"

namespace hgmm::importer {
namespace {

template <typename T>
T loadAs(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

double loadNumber(const char* bytes, const PcdField& field) {
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

/// The fields of a file that are read, and how they become a point.
class PointBuilder {
 public:
    explicit PointBuilder(const PcdHeader& header)
        : xyz_{header.find("x"), header.find("y"), header.find("z")},
          intensity_(header.find("intensity")),
          rgb_(header.find("rgb") ? header.find("rgb") : header.find("rgba")) {
        if (rgb_ && rgb_->size != 4)
            throw std::runtime_error("the field " + rgb_->name + " must have SIZE 4");
    }
    bool hasIntensity() const { return intensity_ != nullptr; }
    bool hasColor() const { return rgb_ != nullptr; }

    /// number(field) gives a field's value, bits(field) its four bytes.
    template <typename Number, typename Bits>
    PcdPoint build(Number number, Bits bits) const {
        PcdPoint point;
        for (int i = 0; i < 3; ++i) point.position[i] = number(*xyz_[i]);
        if (intensity_) point.intensity = static_cast<float>(number(*intensity_));
        if (rgb_) {
            const std::uint32_t color = bits(*rgb_);
            point.r = static_cast<std::uint8_t>(color >> 16);
            point.g = static_cast<std::uint8_t>(color >> 8);
            point.b = static_cast<std::uint8_t>(color);
        }
        return point;
    }

 private:
    const PcdField* xyz_[3];
    const PcdField* intensity_;
    const PcdField* rgb_;
};

[[noreturn]] void failTruncated(std::size_t expected, std::size_t got, const char* unit) {
    throw std::runtime_error("is truncated: its header announces " +
                             std::to_string(expected) + " " + unit + ", there are " +
                             std::to_string(got) + "; fetch or unpack the file again");
}

void requireNothingAfter(const std::string& bytes, std::size_t end) {
    const std::string harmless("\0 \t\r\n", 5);
    if (bytes.find_first_not_of(harmless, end) != std::string::npos)
        throw std::runtime_error(
            "has more data than its header announces; the header's POINTS, "
            "SIZE or COUNT are wrong");
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

/// PCL writes colours as the float or the integer that has their bits.
std::uint32_t colorBits(double value, const PcdField& field) {
    if (field.type == 'F') {
        const auto asFloat = static_cast<float>(value);
        return loadAs<std::uint32_t>(reinterpret_cast<const char*>(&asFloat));
    }
    constexpr double most = std::numeric_limits<std::uint32_t>::max();
    if (!(value >= std::numeric_limits<std::int32_t>::min() && value <= most))
        throw std::runtime_error("the colour " + std::to_string(value) +
                                 " is out of range");
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
}

void readAscii(const PcdHeader& header, const std::string& bytes,
               const PointBuilder& builder, PcdCloud& cloud) {
    const char* text = bytes.c_str() + header.dataOffset;
    std::vector<double> row(header.columns);
    for (std::size_t i = 0; i < header.points; ++i) {
        for (double& value : row) {
            const auto number = nextNumber(text);
            if (!number) failTruncated(header.points, i, "points");
            value = *number;
        }
        cloud.points.push_back(
            builder.build([&](const PcdField& f) { return row[f.column]; },
                          [&](const PcdField& f) { return colorBits(row[f.column], f); }));
    }
    requireNothingAfter(bytes, static_cast<std::size_t>(text - bytes.c_str()));
}

/// Points one after the other, or, if columnwise, all values of a field before those of the
/// next.
void readBinary(const PcdHeader& header, const char* data, bool columnwise,
                const PointBuilder& builder, PcdCloud& cloud) {
    cloud.points.reserve(header.points);
    for (std::size_t i = 0; i < header.points; ++i) {
        const auto at = [&](const PcdField& f) {
            return columnwise ? data + f.offset * header.points + i * f.size
                              : data + i * header.stride + f.offset;
        };
        cloud.points.push_back(
            builder.build([&](const PcdField& f) { return loadNumber(at(f), f); },
                          [&](const PcdField& f) { return loadAs<std::uint32_t>(at(f)); }));
    }
}

std::string unpack(const PcdHeader& header, const std::string& bytes) {
    constexpr std::size_t sizesLength = 8;
    const std::size_t available = bytes.size() - header.dataOffset;
    if (available < sizesLength) failTruncated(sizesLength, available, "bytes of data");
    const char* data = bytes.data() + header.dataOffset;
    const std::size_t packed = loadAs<std::uint32_t>(data);
    const std::size_t size = loadAs<std::uint32_t>(data + 4);
    if (available - sizesLength < packed)
        failTruncated(packed, available - sizesLength, "bytes of compressed data");
    if (size != header.points * header.stride)
        throw std::runtime_error(
            "its compressed data has another size than its header announces");
    requireNothingAfter(bytes, header.dataOffset + sizesLength + packed);
    return unpackLzf(std::string(data + sizesLength, packed), size);
}

PcdCloud parse(const std::string& bytes) {
    const PcdHeader header = parsePcdHeader(bytes);
    const PointBuilder builder(header);
    PcdCloud cloud;
    cloud.viewpoint = header.viewpoint;
    cloud.hasIntensity = builder.hasIntensity();
    cloud.hasColor = builder.hasColor();
    if (header.data == "ascii") {
        readAscii(header, bytes, builder, cloud);
    } else if (header.data == "binary") {
        const std::size_t needed = header.points * header.stride;
        const std::size_t available = bytes.size() - header.dataOffset;
        if (available < needed) failTruncated(needed, available, "bytes of data");
        requireNothingAfter(bytes, header.dataOffset + needed);
        readBinary(header, bytes.data() + header.dataOffset, false, builder, cloud);
    } else {
        readBinary(header, unpack(header, bytes).data(), true, builder, cloud);
    }
    return cloud;
}

}  // namespace

PcdCloud readPcd(const std::string& file) {
    const std::string bytes = readBytes(file);
    try {
        return parse(bytes);
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
}

}  // namespace hgmm::importer
