#include "cell_map/cell_set.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hgmm {

namespace {

constexpr std::uint64_t kRow = 0x1111111111111111;  // cells (0, *, *)
constexpr std::uint64_t kColumn = 0x000F000F000F000F;
constexpr std::uint64_t kLayer = 0xFFFF;

/// Of a word, the cells low to high, 0 to 3, along one axis whose lowest cells are `first`
/// and whose next ones are `stride` bits on.
std::uint64_t slice(std::uint64_t first, int stride, int low, int high) {
    std::uint64_t cells = 0;
    for (int i = low; i <= high; ++i) cells |= first << static_cast<unsigned>(i * stride);
    return cells;
}

}  // namespace

template <typename Visitor>
void CellSet::forEachBlock(const Cell& low, const Cell& high, Visitor&& visit) {
    const auto part = [&](int axis, std::int32_t block, std::uint64_t first, int stride) {
        return slice(first, stride, std::max(low[axis] - 4 * block, 0),
                     std::min(high[axis] - 4 * block, 3));
    };
    for (std::int32_t z = low[2] >> 2; z <= high[2] >> 2; ++z)
        for (std::int32_t y = low[1] >> 2; y <= high[1] >> 2; ++y)
            for (std::int32_t x = low[0] >> 2; x <= high[0] >> 2; ++x)
                if (!visit(LatticeCell{0, x, y, z}, part(0, x, kRow, 1) &
                                                        part(1, y, kColumn, 4) &
                                                        part(2, z, kLayer, 16)))
                    return;
}

void CellSet::requireRoomFor(double blocks) const {
    if (double(blocks_.size()) + blocks > kMaxBlocks)
        throw std::invalid_argument("there are too many cells: choose larger ones");
}

void CellSet::add(const CellCube& cube) {
    // The blocks that a cube holds whole.
    requireRoomFor(std::pow(std::max(0.0, cube.size / 4.0 - 1.0), 3.0));
    Cell high = cube.low;
    for (std::int32_t& c : high) c += cube.size - 1;
    forEachBlock(cube.low, high, [&](const LatticeCell& block, std::uint64_t mask) {
        *blocks_.tryEmplace(block, 0).first |= mask;
        return true;
    });
    requireRoomFor(0);
}

void CellSet::subtract(const CellSet& other) {
    other.blocks_.forEach([&](const LatticeCell& block, std::uint64_t word) {
        if (blocks_.find(block) != nullptr) *blocks_.tryEmplace(block, 0).first &= ~word;
    });
}

bool CellSet::contains(const Cell& cell) const {
    return containsAny(cell, cell);
}

bool CellSet::containsAll(const Cell& low, const Cell& high) const {
    bool all = true;
    forEachBlock(low, high, [&](const LatticeCell& block, std::uint64_t mask) {
        const std::uint64_t* const word = blocks_.find(block);
        all = word != nullptr && (*word & mask) == mask;
        return all;
    });
    return all;
}

bool CellSet::containsAny(const Cell& low, const Cell& high) const {
    bool any = false;
    forEachBlock(low, high, [&](const LatticeCell& block, std::uint64_t mask) {
        const std::uint64_t* const word = blocks_.find(block);
        any = word != nullptr && (*word & mask) != 0;
        return !any;
    });
    return any;
}

}  // namespace hgmm
