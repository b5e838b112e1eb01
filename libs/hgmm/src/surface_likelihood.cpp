#include "hgmm/surface_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hgmm/require.h"

namespace hgmm {

SurfaceLikelihood::SurfaceLikelihood(const Mixture<3>& mixture, double softeningStd_m,
                                     double outlierRatio)
    : index_(ComponentIndex::kSigmas, static_cast<float>(softeningStd_m)),
      outlierRatio_(outlierRatio) {
    requireInRange("softeningStd_m", softeningStd_m, 0.0, 1e3);
    requireInRange("outlierRatio", outlierRatio, 1e-9, 1.0 - 1e-9);
    index_.rebuild(mixture);
}

double SurfaceLikelihood::operator()(float x, float y, float z) const {
    const float point[3] = {x, y, z};
    float nearest = std::numeric_limits<float>::infinity();
    index_.visitCandidates(x, y, z, [&](std::uint32_t j) {
        nearest = std::min(nearest, index_.factor(j).squaredMahalanobis(point));
    });
    return std::log(outlierRatio_ +
                    (1.0 - outlierRatio_) * std::exp(-0.5 * double(nearest)));
}

}  // namespace hgmm
