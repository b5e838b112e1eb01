#pragma once
#include "base/byte_stream.h"
#include "hgmm/map.h"
#include "modality/modalities.h"

namespace hgmm {

/// Names of the modalities to model, then each group: its names, its components.
void putModalities(Writer& out, const MapParams& params, const Modalities& modalities,
                   Encoding encoding);
/// Sets params.modalities. Throws FormatError, or std::out_of_range if the data ends too
/// early.
Modalities getModalities(Reader& in, MapParams& params);

}  // namespace hgmm
