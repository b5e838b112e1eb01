#include "scan/ray_spacing.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hgmm {

namespace {

/// Bins of about 6 degrees on the faces of a cube.
constexpr int kBins = 15;
constexpr double kBinEdge = 2.0 / kBins;

struct DirectionBin {
    std::size_t number;
    double solidAngle;  ///< [sr]
};

DirectionBin binOf(const Eigen::Vector3d& ray) {
    int axis = 0;
    const double largest = ray.cwiseAbs().maxCoeff(&axis);
    const auto bin = [&](double v) {
        return std::clamp(static_cast<int>((v / largest + 1) / kBinEdge), 0, kBins - 1);
    };
    const int face = 2 * axis + (ray[axis] < 0 ? 1 : 0);
    const int row = bin(ray[(axis + 1) % 3]), col = bin(ray[(axis + 2) % 3]);
    const double a = (row + 0.5) * kBinEdge - 1, b = (col + 0.5) * kBinEdge - 1,
                 distance2 = 1 + a * a + b * b;
    return {static_cast<std::size_t>((face * kBins + row) * kBins + col),
            kBinEdge * kBinEdge / (distance2 * std::sqrt(distance2))};
}

}  // namespace

double raySpacing(const Mixture<3>& samples_sensor,
                  const Eigen::Vector3d& normalOfRays_sensor) {
    std::vector<double> raysOf(std::size_t{6} * kBins * kBins, 0.0);
    std::vector<DirectionBin> bins;
    for (std::size_t i = 0; i < samples_sensor.size(); ++i) {
        const Eigen::Vector3d ray = samples_sensor[i].mean;
        if (!(ray.squaredNorm() > 0)) continue;
        bins.push_back(binOf(ray));
        raysOf[bins.back().number] += samples_sensor.support[i];
    }
    if (bins.empty()) return 0.0;
    const bool isPlanar = !normalOfRays_sensor.isZero();
    std::vector<double> spacings;
    spacings.reserve(bins.size());
    for (const DirectionBin& bin : bins) {
        const double rays = raysOf[bin.number];
        spacings.push_back(isPlanar ? std::sqrt(bin.solidAngle) / rays
                                    : std::sqrt(bin.solidAngle / rays));
    }
    const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
    std::nth_element(spacings.begin(), middle, spacings.end());
    return *middle;
}

}  // namespace hgmm
