// Map::load: the bytes are a saved map, whose head is made to fit.
#include "allocations.h"
#include "harness.h"
#include "map_buffer.h"
#include "oracle.h"

namespace hgmm::fuzz {

namespace {

/// What SECURITY.md says of the memory that loading takes.
constexpr std::size_t kBytesPerByte = 4096, kBytesBesides = std::size_t{4} << 20U;

}  // namespace

void runOne(const std::uint8_t* data, std::size_t size) {
    std::vector<std::uint8_t> bytes(data, data + size);
    repairHead(bytes, 0);
    Map map;
    const PeakOfAllocations peak;
    try {
        map = Map::load(bytes.data(), bytes.size());
    } catch (const FormatError&) {
    }
    require(peak.bytes() <= kBytesPerByte * size + kBytesBesides,
            "loading takes no more memory than it may");
    constexpr std::size_t kMostComponents = 2000;
    if (map.mixture().size() + map.freeMixture().size() > kMostComponents) return;
    requireSoundAnswers(map, size);
    requireStableSaving(map);
}

}  // namespace hgmm::fuzz
