#include "hgmm/evaluation/range_noise.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {

void addRangeNoise(Scan& scan, double std_m, std::uint64_t seed, std::size_t scanIndex) {
    if (!(std_m >= 0.0 && std::isfinite(std_m)))
        throw std::invalid_argument("range noise must be at least 0 m, but is " +
                                    std::to_string(std_m));
    std::mt19937_64 stream = randomStream(seed, scanIndex, Draw::rangeNoise);
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const double noise_m = std_m * nextNormal(stream);
        const double range_m = std::hypot(scan.x[i], scan.y[i], scan.z[i]);
        if (!(range_m > 0.0 && std::isfinite(range_m))) continue;
        const auto scale = static_cast<float>((range_m + noise_m) / range_m);
        scan.x[i] *= scale;
        scan.y[i] *= scale;
        scan.z[i] *= scale;
    }
}

}  // namespace hgmm::evaluation
