#include "occupancy/band_kernel_loops.h"
#include "occupancy/band_kernels.h"

namespace hgmm::bands {

#if defined(__x86_64__)
extern const Kernel kAvx2;  // band_kernel_avx2.cpp
#endif

std::vector<const Kernel*> kernels() {
    static const Kernel baseline{"baseline", place,    inside,    placeNear,
                                 within,     evaluate, normalFall};
    std::vector<const Kernel*> found{&baseline};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) found.push_back(&kAvx2);
#endif
    return found;
}

const Kernel& kernel() {
    static const Kernel& fastest = *kernels().back();
    return fastest;
}

}  // namespace hgmm::bands
