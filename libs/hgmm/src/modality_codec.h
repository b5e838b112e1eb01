#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/modality_group.h"

namespace hgmm {

/// Appends the components of a group, names included, as they are saved compactly.
void encodeModalities(const ModalityGroup& group, std::vector<std::uint8_t>& bytes);

}  // namespace hgmm
