#include "io/coverage_codec.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <tuple>

#include "base/byte_stream.h"
#include "hgmm/map.h"
#include "io/bit_coder.h"
#include "io/coverage_words.h"

namespace hgmm {

namespace {

using Word = Coverage::Word;
using Blocks = LatticeTable<Word>;

/// Of a cell: ten neighbours, and whether none, some or all of it is marked in the lattice
/// of half its edge.
constexpr std::size_t kContexts = 3 * 1024;
/// So that a pyramid spans all the blocks that there can be, 2e9 along an axis.
constexpr int kMostLevels = 17;
/// Damaged data must not ask for memory without end: real blocks take a byte each.
constexpr std::uint64_t kMostBlocksPerByte = 64;

/// Neighbours that come before a cell, in the order of their bits in its context.
struct Offset {
    int x, y, z;
};
constexpr std::array<Offset, 10> kBefore = {{{1, 0, 0},
                                             {0, 1, 0},
                                             {0, 0, 1},
                                             {1, 1, 0},
                                             {1, 0, 1},
                                             {0, 1, 1},
                                             {2, 0, 0},
                                             {0, 2, 0},
                                             {0, 0, 2},
                                             {1, 1, 1}}};

/// The cells of a block and of the two layers before it, one byte each.
class Surroundings {
 public:
    Surroundings(const Blocks& blocks, const LatticeCell& block) {
        for (int k = 1; k < 8; ++k) {
            const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
            const Word* const word =
                blocks.find({block.octave, block.x - dx, block.y - dy, block.z - dz});
            if (word == nullptr) continue;
            for (int z = dz != 0 ? 2 : 0; z < 4; ++z)
                for (int y = dy != 0 ? 2 : 0; y < 4; ++y)
                    for (int x = dx != 0 ? 2 : 0; x < 4; ++x)
                        at(x - 4 * dx, y - 4 * dy, z - 4 * dz) =
                            static_cast<std::uint8_t>(*word >> (x + 4 * y + 16 * z) & 1U);
        }
    }
    std::uint8_t& at(int x, int y, int z) { return cells_[z + 2][y + 2][x + 2]; }
    std::size_t context(int x, int y, int z) {
        std::size_t context = 0;
        for (std::size_t k = 0; k < kBefore.size(); ++k)
            context |= std::size_t{at(x - kBefore[k].x, y - kBefore[k].y, z - kBefore[k].z)}
                       << k;
        return context;
    }

 private:
    std::uint8_t cells_[6][6][6] = {};
};

/// What the lattice of half the edge says of the cells of a block: for each, 0 = nothing of
/// it is marked, 1 = some, 2 = all.
class Halves {
 public:
    /// @param block in the coordinates of `coverage`
    Halves(const Coverage& coverage, const LatticeCell& block) {
        for (int k = 0; k < 8; ++k)
            words_[k] = coverage.word({block.octave - 1, 2 * block.x + (k & 1),
                                       2 * block.y + (k >> 1 & 1), 2 * block.z + (k >> 2)});
    }
    std::size_t of(int x, int y, int z) const {
        constexpr Word kChildren = 0x330033;  // two cells along each axis
        const Word word = words_[(x >> 1) + 2 * (y >> 1) + 4 * (z >> 1)];
        const Word children =
            word >> (2 * (x & 1) + 8 * (y & 1) + 32 * (z & 1)) & kChildren;
        return children == 0 ? 0 : children == kChildren ? 2 : 1;
    }

 private:
    Word words_[8];
};

using Models = std::vector<BitModel>;

/// Codes the cells of a block one by one: code(bit, model) returns the bit.
template <typename Code>
Word codeBlock(const Blocks& blocks, const LatticeCell& block, Word cells,
               const std::optional<Halves>& halves, Models& models, Code&& code) {
    Surroundings around(blocks, block);
    Word coded = 0;
    for (int bit = 0; bit < 64; ++bit) {
        const int x = bit & 3, y = bit >> 2 & 3, z = bit >> 4;
        std::size_t context = around.context(x, y, z);
        if (halves) context = 3 * context + halves->of(x, y, z);
        const bool is = code((cells >> bit & 1U) != 0, models[context]);
        around.at(x, y, z) = is ? 1 : 0;
        coded |= Word{is} << bit;
    }
    return coded;
}

/// So that neighbours before a cell lie in blocks before its own.
bool comesBefore(const LatticeCell& a, const LatticeCell& b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
}

std::vector<LatticeCell> inOrder(const Blocks& blocks) {
    std::vector<LatticeCell> order;
    order.reserve(blocks.size());
    blocks.forEach([&](const LatticeCell& block, Word) { order.push_back(block); });
    std::sort(order.begin(), order.end(), comesBefore);
    return order;
}

/// Which blocks there are, as the cells of blocks four times their size.
Blocks presence(const Blocks& blocks) {
    Blocks upper;
    blocks.forEach([&](const LatticeCell& b, Word) {
        *upper.tryEmplace({b.octave, b.x >> 2, b.y >> 2, b.z >> 2}, 0).first |=
            Word{1} << ((b.x & 3) + 4 * (b.y & 3) + 16 * (b.z & 3));
    });
    return upper;
}

/// The blocks that the cells of the level above say are there, empty.
std::vector<LatticeCell> children(const Blocks& upper, std::uint64_t most) {
    constexpr std::int32_t kFarthest = std::numeric_limits<std::int32_t>::max() / 4 - 1;
    std::vector<LatticeCell> found;
    for (const LatticeCell& b : inOrder(upper)) {
        if (std::max({b.x, b.y, b.z}) > kFarthest)
            throw FormatError("saved map: a block of coverage is out of range");
        Word word = *upper.find(b);
        for (; word != 0; word &= word - 1) {
            const int bit = __builtin_ctzll(word);
            found.push_back({b.octave, 4 * b.x + (bit & 3), 4 * b.y + (bit >> 2 & 3),
                             4 * b.z + (bit >> 4)});
            if (found.size() > most)
                throw FormatError("saved map: coverage has more blocks than it says");
        }
    }
    std::sort(found.begin(), found.end(), comesBefore);
    return found;
}

using Corner = std::array<std::int32_t, 3>;

LatticeCell moved(const LatticeCell& block, const Corner& corner) {
    return {block.octave, block.x + corner[0], block.y + corner[1], block.z + corner[2]};
}

/// Throws FormatError for a block that could not be moved by the corner of all.
void requireInRange(const LatticeCell& block, const Corner& corner) {
    constexpr std::int64_t kLimit = kFarthestCoverageBlock;
    if (std::max({std::int64_t{block.x} + corner[0], std::int64_t{block.y} + corner[1],
                  std::int64_t{block.z} + corner[2]}) > kLimit)
        throw FormatError("saved map: a block of coverage is out of range");
}

/// Only cells have a finer lattice: the levels above them say where blocks are.
std::optional<Halves> halvesAt(std::size_t level, const Coverage& coverage,
                               const LatticeCell& block) {
    if (level > 0) return std::nullopt;
    return Halves(coverage, block);
}

/// One octave's blocks, from the corner of all of them on.
struct Octave {
    std::int8_t octave = 0;
    Corner corner{};
    Blocks blocks;
};

Octave octaveOfCoverage(const Coverage& coverage, int octave) {
    Octave result;
    result.octave = static_cast<std::int8_t>(octave);
    result.corner.fill(std::numeric_limits<std::int32_t>::max());
    coverage.forEachBlock([&](const LatticeCell& b, Word) {
        if (b.octave != octave) return;
        result.corner = {std::min(result.corner[0], b.x), std::min(result.corner[1], b.y),
                         std::min(result.corner[2], b.z)};
    });
    coverage.forEachBlock([&](const LatticeCell& b, Word word) {
        if (b.octave != octave) return;
        *result.blocks
             .tryEmplace({octave, b.x - result.corner[0], b.y - result.corner[1],
                          b.z - result.corner[2]},
                         0)
             .first = word;
    });
    return result;
}

}  // namespace

void encodeCoverage(const Coverage& coverage, std::vector<std::uint8_t>& out) {
    Writer writer(out);
    writer.put(static_cast<std::uint8_t>(coverage.octaves().size()));
    std::vector<std::vector<Blocks>> pyramids;
    std::vector<Corner> corners;
    for (const int octave : coverage.octaves()) {
        Octave base = octaveOfCoverage(coverage, octave);
        std::vector<Blocks> levels = {std::move(base.blocks)};
        const auto isOne = [](const Blocks& b) {
            return b.size() == 1 && b.find({inOrder(b).front().octave, 0, 0, 0}) != nullptr;
        };
        while (!isOne(levels.back())) levels.push_back(presence(levels.back()));
        writer.put(base.octave);
        writer.put(base.corner.data(), 3);
        writer.put(static_cast<std::uint8_t>(levels.size()));
        writer.put(static_cast<std::uint64_t>(levels.front().size()));
        pyramids.push_back(std::move(levels));
        corners.push_back(base.corner);
    }
    BitEncoder encoder(out);
    for (std::size_t p = 0; p < pyramids.size(); ++p) {
        const std::vector<Blocks>& levels = pyramids[p];
        for (std::size_t l = levels.size(); l-- > 0;) {
            Models models(kContexts);
            for (const LatticeCell& block : inOrder(levels[l])) {
                const auto halves = halvesAt(l, coverage, moved(block, corners[p]));
                codeBlock(levels[l], block, *levels[l].find(block), halves, models,
                          [&](bool bit, BitModel& model) {
                              encoder.put(bit, model);
                              return bit;
                          });
            }
        }
    }
    encoder.finish();
}

std::size_t decodeCoverage(const std::uint8_t* data, std::size_t size, Coverage& coverage) {
    struct Head {
        std::int8_t octave;
        Corner corner;
        std::uint8_t levels;
        std::uint64_t blocks;
    };
    Reader reader(data, size);
    const auto octaves = reader.get<std::uint8_t>();
    if (octaves == kCoverageWords) return 1 + readCoverageWords(reader, coverage);
    std::vector<Head> heads(octaves);
    for (Head& head : heads) {
        head.octave = reader.get<std::int8_t>();
        reader.get(head.corner.data(), 3);
        head.levels = reader.get<std::uint8_t>();
        head.blocks = reader.get<std::uint64_t>();
        const auto& [x, y, z] = head.corner;
        if (head.levels < 1 || head.levels > kMostLevels ||
            head.blocks > kMostBlocksPerByte * size ||
            !isCoverageBlock({head.octave, x, y, z}))
            throw FormatError("saved map: a lattice of coverage is out of range");
    }
    BitDecoder decoder(reader.here(), reader.left());
    for (const Head& head : heads) {
        Blocks blocks;
        std::vector<LatticeCell> order = {{head.octave, 0, 0, 0}};
        for (int l = head.levels; l-- > 0;) {
            blocks = Blocks();
            Models models(kContexts);
            for (const LatticeCell& block : order) {
                if (l == 0) requireInRange(block, head.corner);
                const auto halves = halvesAt(l, coverage, moved(block, head.corner));
                const Word cells =
                    codeBlock(blocks, block, 0, halves, models,
                              [&](bool, BitModel& model) { return decoder.get(model); });
                *blocks.tryEmplace(block, 0).first = cells;
            }
            if (l > 0) order = children(blocks, head.blocks);
        }
        blocks.forEach([&](const LatticeCell& b, Word cells) {
            if (cells == 0) throw FormatError("saved map: a block of coverage is empty");
            coverage.mark(moved(b, head.corner), cells);
        });
    }
    return size - reader.left() + decoder.read();
}

}  // namespace hgmm
