#include "index/cell_order.h"

#include <algorithm>
#include <utility>

#include "base/lattice.h"

namespace hgmm {

namespace {

/// The low 21 bits of a coordinate, two places apart.
std::uint64_t spread(std::int32_t coordinate) {
    std::uint64_t v = static_cast<std::uint32_t>(coordinate) & 0x1FFFFFU;
    v = (v | v << 32U) & 0x001F00000000FFFFULL;
    v = (v | v << 16U) & 0x001F0000FF0000FFULL;
    v = (v | v << 8U) & 0x100F00F00F00F00FULL;
    v = (v | v << 4U) & 0x10C30C30C30C30C3ULL;
    return (v | v << 2U) & 0x1249249249249249ULL;
}

}  // namespace

CellOrder orderedByCells(const float* x, const float* y, const float* z, std::size_t n,
                         int octave) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(n);
    for (std::size_t i = 0; i < n; ++i) {
        const LatticeCell cell = LatticeCell::at({x[i], y[i], z[i]}, octave);
        keys[i] = {spread(cell.x) | spread(cell.y) << 1U | spread(cell.z) << 2U,
                   static_cast<std::uint32_t>(i)};
    }
    std::sort(keys.begin(), keys.end());
    CellOrder order;
    order.index.reserve(n);
    for (std::vector<float>* axis : {&order.x, &order.y, &order.z}) axis->reserve(n + 3);
    for (const auto& [key, i] : keys) {
        order.index.push_back(i);
        order.x.push_back(x[i]);
        order.y.push_back(y[i]);
        order.z.push_back(z[i]);
    }
    for (std::vector<float>* axis : {&order.x, &order.y, &order.z}) axis->resize(n + 3);
    return order;
}

}  // namespace hgmm
