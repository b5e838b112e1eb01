#pragma once
#include <cstddef>
#include <string>

#include "cloud_layout.h"
#include "recorded_cloud.h"

namespace hgmm::importer {

/// How the numbers of a binary file stand.
enum class BinaryOrder {
    points,   ///< a point after the other
    columns,  ///< all values of a field before those of the next
};

/// The points of a text, from an offset on. Returns the offset behind the last one. Throws
/// std::runtime_error if there are too few or a word is no number.
std::size_t readAsciiPoints(const CloudLayout& layout, const std::string& bytes,
                            std::size_t offset, RecordedCloud& cloud);

/// The points of layout.points * layout.stride little-endian bytes.
void readBinaryPoints(const CloudLayout& layout, const char* data, BinaryOrder order,
                      RecordedCloud& cloud);

/// Throws std::runtime_error if a file has fewer than it announces.
void requireBytes(std::size_t announced, std::size_t available, const char* what);

}  // namespace hgmm::importer
