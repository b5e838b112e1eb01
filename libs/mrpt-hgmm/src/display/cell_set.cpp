#include "display/cell_set.h"

#include <algorithm>

namespace hgmm::mrpt_bridge {

namespace {

constexpr unsigned kKeyBits = 21;

int popcount(std::uint64_t word) {
    return __builtin_popcountll(word);
}

unsigned bitOf(std::int32_t y, std::int32_t z) {
    return 8U * (static_cast<unsigned>(y) & 7U) + (static_cast<unsigned>(z) & 7U);
}

/// Coordinate `axis` (0 to 2) of a block's lowest cell.
std::int32_t lowest(std::uint64_t key, unsigned axis) {
    const std::uint64_t mask = (std::uint64_t{1} << kKeyBits) - 1U;
    const auto block = static_cast<std::int32_t>(key >> (kKeyBits * (2U - axis)) & mask);
    return 8 * block - CellSet::kReach;
}

}  // namespace

// Counted from the lowest possible block, so that sorted keys are sorted coordinates.
std::uint64_t CellSet::keyOf(const Cell& cell) {
    const auto block = [](std::int32_t v) {
        return static_cast<std::uint64_t>((v + kReach) >> 3);
    };
    return block(cell.x) << (2U * kKeyBits) | block(cell.y) << kKeyBits | block(cell.z);
}

void CellSet::insertRow(std::int32_t x, std::int32_t y, std::int32_t z0, std::int32_t z1) {
    for (std::int32_t z = z0; z <= z1;) {
        std::uint64_t& word = blocks_[keyOf({x, y, z})].layers[x & 7];
        const std::int32_t end = std::min(z1, z | 7);  // the last one in this block
        const std::uint64_t run = (std::uint64_t{2} << static_cast<unsigned>(end - z)) - 1U;
        const std::uint64_t added = run << bitOf(y, z) & ~word;
        word |= added;
        size_ += static_cast<std::size_t>(popcount(added));
        z = end + 1;
    }
}

std::vector<Cell> CellSet::enumerate() {
    std::vector<std::uint64_t> keys;
    keys.reserve(blocks_.size());
    for (const auto& entry : blocks_) keys.push_back(entry.first);
    std::sort(keys.begin(), keys.end());
    std::vector<Cell> cells;
    cells.reserve(size_);
    for (const std::uint64_t key : keys) {
        Block& block = blocks_.at(key);
        block.first = cells.size();
        for (std::int32_t x = 0; x < 8; ++x)
            for (std::uint64_t rest = block.layers[x]; rest != 0; rest &= rest - 1U) {
                const int bit = __builtin_ctzll(rest);
                cells.push_back({lowest(key, 0) + x, lowest(key, 1) + bit / 8,
                                 lowest(key, 2) + bit % 8});
            }
    }
    return cells;
}

std::size_t CellSet::indexOf(const Cell& cell) const {
    const auto found = blocks_.find(keyOf(cell));
    if (found == blocks_.end()) return size_;
    const Block& block = found->second;
    const auto layer = static_cast<std::size_t>(cell.x & 7);
    const std::uint64_t bit = std::uint64_t{1} << bitOf(cell.y, cell.z);
    if ((block.layers[layer] & bit) == 0) return size_;
    std::size_t index = block.first;
    for (std::size_t x = 0; x < layer; ++x)
        index += static_cast<std::size_t>(popcount(block.layers[x]));
    return index + static_cast<std::size_t>(popcount(block.layers[layer] & (bit - 1U)));
}

}  // namespace hgmm::mrpt_bridge
