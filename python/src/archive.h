#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/map.h"

namespace hgmm::python {

/// The buffer of Map::save that is in the content of a `.hgmm` file: an object of MRPT's
/// serialisation, as docs/formats.md describes it. Options for MRPT's programs, how maps
/// are drawn and localised in, are skipped. Throws FormatError for another class, a newer
/// version, an option of the model that is not known, or bytes too few or too many.
std::vector<std::uint8_t> unwrapped(const std::vector<std::uint8_t>& object);

/// The content of a `.hgmm` file with the map in it. MRPT's options have their defaults.
std::vector<std::uint8_t> wrapped(const Map& map, Encoding encoding);

}  // namespace hgmm::python
