// The MRPT object around a map: the bytes are its version and what is behind it in a
// stream. A saved map inside has its head made to fit.
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <string>

#include "harness.h"
#include "map_buffer.h"
#include "oracle.h"

namespace hgmm::fuzz {

namespace {

using mrpt::maps::CHGMMOccupancyMap;

std::vector<std::uint8_t> asStream(std::vector<std::uint8_t> object) {
    const char magic[] = {'H', 'G', 'M', 'M'};
    const auto map =
        std::search(object.begin(), object.end(), std::begin(magic), std::end(magic));
    if (map != object.end())
        repairHead(object, static_cast<std::size_t>(map - object.begin()));
    const std::string name = "mrpt::maps::CHGMMOccupancyMap";
    std::vector<std::uint8_t> stream = {static_cast<std::uint8_t>(name.size() | 0x80U)};
    stream.insert(stream.end(), name.begin(), name.end());
    stream.insert(stream.end(), object.begin(), object.end());
    stream.push_back(0x88);
    return stream;
}

void read(const std::vector<std::uint8_t>& stream, CHGMMOccupancyMap& map) {
    mrpt::io::CMemoryStream memory;
    memory.assignMemoryNotOwn(stream.data(), stream.size());
    mrpt::serialization::archiveFrom(memory).ReadObject(&map);
}

std::vector<std::uint8_t> written(const CHGMMOccupancyMap& map) {
    mrpt::io::CMemoryStream memory;
    mrpt::serialization::archiveFrom(memory) << map;
    const auto* begin = static_cast<const std::uint8_t*>(memory.getRawBufferData());
    return {begin, begin + memory.getTotalBytesCount()};
}

}  // namespace

void runOne(const std::uint8_t* data, std::size_t size) {
    CHGMMOccupancyMap map;
    try {
        read(asStream({data, data + size}), map);
    } catch (const std::exception&) {
        require(map.model() == Map(), "an object that is refused leaves the map as it was");
        return;
    }
    const std::vector<std::uint8_t> first = written(map);
    CHGMMOccupancyMap again;
    read(first, again);
    require(written(again) == first, "an object that was read writes the same bytes");
}

}  // namespace hgmm::fuzz
