// Compiled for AVX2 (CMakeLists.txt). Called where the processor has it.
#if defined(__x86_64__)
#include "occupancy/band_kernel_loops.h"

namespace hgmm::bands {

extern const Kernel kAvx2;
const Kernel kAvx2{"AVX2", place, inside, placeNear, within, evaluate, normalFall};

}  // namespace hgmm::bands
#endif
