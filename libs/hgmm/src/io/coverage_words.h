#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/byte_stream.h"
#include "base/lattice.h"
#include "occupancy/coverage.h"

namespace hgmm {

/// Stands where encoded coverage has the number of its octaves.
constexpr std::uint8_t kCoverageWords = 255;

/// Farthest block along an axis, in either direction.
constexpr std::int32_t kFarthestCoverageBlock = 1000000000;

/// Whether a saved block can be one: damaged data may say anything.
bool isCoverageBlock(const LatticeCell& block);

/// Coverage as plain words, for copies of maps in a particle filter, which
/// are made too often to be encoded.
void writeCoverage(const Coverage& coverage, std::vector<std::uint8_t>& out);

/// Reads what writeCoverage wrote, after kCoverageWords. Returns the bytes read. Throws
/// std::out_of_range if the data ends too early, FormatError if it cannot be a coverage.
std::size_t readCoverageWords(Reader reader, Coverage& coverage);

}  // namespace hgmm
