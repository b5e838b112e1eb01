#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hgmm {

/// Points in an order in which those of one cell follow each other, on the lattices of all
/// octaves from one up.
struct CellOrder {
    std::vector<std::uint32_t> index;  ///< of each in the points given
    std::vector<float> x, y, z;  ///< [m]; three zeros follow, for loads of four at a time

    std::size_t size() const { return index.size(); }
};

/// The points of a CellOrder, without their coordinates.
std::vector<std::uint32_t> orderOfCells(const float* x, const float* y, const float* z,
                                        std::size_t n, int octave);

/// Sorts points along Morton's curve through the cells of an octave. Points of one cell
/// keep their order. The order matters for speed alone.
/// @param x, y, z n coordinates each [m]
CellOrder orderedByCells(const float* x, const float* y, const float* z, std::size_t n,
                         int octave);

}  // namespace hgmm
