#pragma once
#include <cstdint>
#include <vector>

namespace equality {

/// What a buffer of hgmm::Map::save holds besides options, whose names and number differ
/// between trees: version, origin and components. Size and checksum cover the options, too,
/// and are left out.
std::vector<std::uint8_t> withoutOptions(const std::vector<std::uint8_t>& saved);

/// The same for an MRPT object, which ends in such a buffer behind options of its own.
std::vector<std::uint8_t> withoutOptionsOfObject(const std::vector<std::uint8_t>& object);

}  // namespace equality
