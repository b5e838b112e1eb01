#pragma once
#include <vector>

#include "occupancy/band_kernel.h"

namespace hgmm::bands {

/// Those that this processor runs, the fastest last.
std::vector<const Kernel*> kernels();
/// The fastest one.
const Kernel& kernel();

}  // namespace hgmm::bands
