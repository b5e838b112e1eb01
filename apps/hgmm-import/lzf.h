#pragma once
#include <cstddef>
#include <string>

namespace hgmm::importer {

/// Unpacks a block of the LZF format, which PCD's binary_compressed uses: a control byte
/// below 32 starts that many literal bytes plus one; otherwise its upper three bits are the
/// length and its lower five the high bits of the distance of a repetition. Throws
/// std::runtime_error unless the block is whole and unpacks to exactly the given size.
std::string unpackLzf(const std::string& packed, std::size_t size);

}  // namespace hgmm::importer
