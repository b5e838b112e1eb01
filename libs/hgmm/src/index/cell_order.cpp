#include "index/cell_order.h"

#include <array>
#include <utility>

#include "base/lattice.h"

namespace hgmm {

namespace {

struct CellKey {
    std::uint64_t key;
    std::uint32_t index;
};

/// The low 21 bits of a coordinate, two places apart.
std::uint64_t spread(std::int32_t coordinate) {
    std::uint64_t v = static_cast<std::uint32_t>(coordinate) & 0x1FFFFFU;
    v = (v | v << 32U) & 0x001F00000000FFFFULL;
    v = (v | v << 16U) & 0x001F0000FF0000FFULL;
    v = (v | v << 8U) & 0x100F00F00F00F00FULL;
    v = (v | v << 4U) & 0x10C30C30C30C30C3ULL;
    return (v | v << 2U) & 0x1249249249249249ULL;
}

/// Sorts by key, those of the same key as they came: by digits from the lowest, leaving out
/// those that all keys share.
void sortByDigits(std::vector<CellKey>& keys) {
    constexpr unsigned kDigitBits = 8;
    constexpr std::uint64_t kDigit = (1U << kDigitBits) - 1U;
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (const CellKey& k : keys) any |= k.key, all &= k.key;
    std::vector<CellKey> sorted(keys.size());
    for (unsigned shift = 0; shift < 64; shift += kDigitBits) {
        if (((any ^ all) >> shift & kDigit) == 0) continue;
        std::array<std::uint32_t, kDigit + 1> place{};
        for (const CellKey& k : keys) ++place[k.key >> shift & kDigit];
        std::uint32_t before = 0;
        for (std::uint32_t& p : place) before += std::exchange(p, before);
        for (const CellKey& k : keys) sorted[place[k.key >> shift & kDigit]++] = k;
        keys.swap(sorted);
    }
}

}  // namespace

std::vector<std::uint32_t> orderOfCells(const float* x, const float* y, const float* z,
                                        std::size_t n, int octave) {
    std::vector<CellKey> keys(n);
    for (std::size_t i = 0; i < n; ++i) {
        const LatticeCell cell = LatticeCell::at({x[i], y[i], z[i]}, octave);
        keys[i] = {spread(cell.x) | spread(cell.y) << 1U | spread(cell.z) << 2U,
                   static_cast<std::uint32_t>(i)};
    }
    sortByDigits(keys);
    std::vector<std::uint32_t> index;
    index.reserve(n);
    for (const CellKey& k : keys) index.push_back(k.index);
    return index;
}

CellOrder orderedByCells(const float* x, const float* y, const float* z, std::size_t n,
                         int octave) {
    CellOrder order;
    order.index = orderOfCells(x, y, z, n, octave);
    const auto ordered = [&](const float* from, std::vector<float>& axis) {
        axis.reserve(n + 3);
        for (const std::uint32_t i : order.index) axis.push_back(from[i]);
        axis.resize(n + 3);
    };
    ordered(x, order.x);
    ordered(y, order.y);
    ordered(z, order.z);
    return order;
}

}  // namespace hgmm
