#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "occupancy/coverage.h"

namespace hgmm {

/// Coverage as it is saved, without loss: for each octave a pyramid of bits, from the block
/// that holds everything, whose bits say which parts of it hold anything, down to the
/// cells. Each bit is coded by what it is beside (BitModel): ten neighbours that come
/// before it, and, for a cell, how much of it is marked in the lattice of half its edge.
void encodeCoverage(const Coverage& coverage, std::vector<std::uint8_t>& out);

/// Reads what encodeCoverage or writeCoverage (coverage_words.h) wrote. Returns the bytes
/// read. Throws std::out_of_range if the data ends too early, FormatError if it cannot be a
/// coverage.
std::size_t decodeCoverage(const std::uint8_t* data, std::size_t size, Coverage& coverage);

}  // namespace hgmm
