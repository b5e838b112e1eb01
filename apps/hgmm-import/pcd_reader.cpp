#include "pcd_reader.h"

#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "cloud_data.h"
#include "cloud_fields.h"
#include "files.h"
#include "lzf.h"
#include "pcd_header.h"

namespace hgmm::importer {
namespace {

std::uint32_t loadSize(const char* bytes) {
    std::uint32_t size = 0;
    std::memcpy(&size, bytes, sizeof size);
    return size;
}

void requireNothingAfter(const std::string& bytes, std::size_t end) {
    const std::string harmless("\0 \t\r\n", 5);
    if (bytes.find_first_not_of(harmless, end) != std::string::npos)
        throw std::runtime_error(
            "has more data than its header announces; the header's POINTS, "
            "SIZE or COUNT are wrong");
}

std::string unpack(const PcdHeader& header, const std::string& bytes) {
    constexpr std::size_t sizesLength = 8;
    const std::size_t available = bytes.size() - header.dataOffset;
    requireBytes(sizesLength, available, "bytes of data");
    const char* data = bytes.data() + header.dataOffset;
    const std::size_t packed = loadSize(data);
    const std::size_t size = loadSize(data + 4);
    requireBytes(packed, available - sizesLength, "bytes of compressed data");
    if (size != header.layout.points * header.layout.stride)
        throw std::runtime_error(
            "its compressed data has another size than its header announces");
    requireNothingAfter(bytes, header.dataOffset + sizesLength + packed);
    return unpackLzf(std::string(data + sizesLength, packed), size);
}

RecordedCloud parsePcd(const std::string& bytes) {
    const PcdHeader header = parsePcdHeader(bytes);
    const CloudLayout& layout = header.layout;
    RecordedCloud cloud = CloudFields(layout).emptyCloud();
    cloud.viewpoint = header.viewpoint;
    if (header.data == "ascii") {
        requireNothingAfter(bytes,
                            readAsciiPoints(layout, bytes, header.dataOffset, cloud));
    } else if (header.data == "binary") {
        const std::size_t needed = layout.points * layout.stride;
        requireBytes(needed, bytes.size() - header.dataOffset, "bytes of data");
        requireNothingAfter(bytes, header.dataOffset + needed);
        readBinaryPoints(layout, bytes.data() + header.dataOffset, BinaryOrder::points,
                         cloud);
    } else {
        readBinaryPoints(layout, unpack(header, bytes).data(), BinaryOrder::columns, cloud);
    }
    return cloud;
}

}  // namespace

RecordedCloud readPcd(const std::string& file) {
    const std::string bytes = readBytes(file);
    try {
        return parsePcd(bytes);
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
}

}  // namespace hgmm::importer
