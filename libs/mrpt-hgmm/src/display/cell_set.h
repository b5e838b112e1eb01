#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace hgmm::mrpt_bridge {

/// Place in a lattice of cubes.
struct Cell {
    std::int32_t x, y, z;
};

/// A sparse set of cells within kReach of the origin, one bit each, in blocks of 8 x 8 x 8.
class CellSet {
 public:
    static constexpr std::int32_t kReach = 1 << 22;

    /// Enters cells (x, y, z0) to (x, y, z1).
    void insertRow(std::int32_t x, std::int32_t y, std::int32_t z0, std::int32_t z1);
    std::size_t size() const { return size_; }

    /// All cells, in an order that depends on nothing but the set; numbers them for
    /// indexOf.
    std::vector<Cell> enumerate();
    /// Place of a cell in the last enumeration, or its size for a cell not in the set.
    std::size_t indexOf(const Cell& cell) const;

 private:
    struct Block {
        std::array<std::uint64_t, 8> layers{};  // one word per x, bit 8 y + z
        std::size_t first = 0;                  // number of its first cell
    };

    static std::uint64_t keyOf(const Cell& cell);

    std::unordered_map<std::uint64_t, Block> blocks_;
    std::size_t size_ = 0;
};

}  // namespace hgmm::mrpt_bridge
