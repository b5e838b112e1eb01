#include "io/coverage_words.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "hgmm/map.h"

namespace hgmm {

namespace {

/// A block as it is written.
struct BlockWord {
    std::int32_t octave, x, y, z;
    Coverage::Word cells;
};

}  // namespace

bool isCoverageBlock(const LatticeCell& block) {
    constexpr int kMostOctave = 40;
    bool isOne = block.octave >= -kMostOctave && block.octave <= kMostOctave;
    for (const std::int32_t c : {block.x, block.y, block.z})
        isOne = isOne && std::abs(std::int64_t{c}) <= kFarthestCoverageBlock;
    return isOne;
}

void writeCoverage(const Coverage& coverage, std::vector<std::uint8_t>& out) {
    std::vector<BlockWord> blocks;
    blocks.reserve(coverage.blockCount());
    coverage.forEachBlock([&](const LatticeCell& b, Coverage::Word word) {
        blocks.push_back({b.octave, b.x, b.y, b.z, word});
    });
    // Equal maps give equal bytes.
    std::sort(blocks.begin(), blocks.end(), [](const BlockWord& a, const BlockWord& b) {
        return std::tie(a.octave, a.z, a.y, a.x) < std::tie(b.octave, b.z, b.y, b.x);
    });
    Writer writer(out);
    writer.put(kCoverageWords);
    writer.put(static_cast<std::uint64_t>(blocks.size()));
    writer.put(blocks.data(), blocks.size());
}

std::size_t readCoverageWords(Reader reader, Coverage& coverage) {
    const std::size_t size = reader.left();
    const auto n = reader.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < n; ++i) {
        const auto b = reader.get<BlockWord>();
        const LatticeCell block{b.octave, b.x, b.y, b.z};
        if (b.cells == 0 || !isCoverageBlock(block))
            throw FormatError("saved map: a block of coverage is out of range");
        coverage.mark(block, b.cells);
    }
    return size - reader.left();
}

}  // namespace hgmm
