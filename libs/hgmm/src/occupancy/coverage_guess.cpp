#include "occupancy/coverage_guess.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/power_of_two.h"

namespace hgmm {

namespace {

/// Marks the cells whose centres lie within `sigmas` of a Gaussian. Their edge is its
/// smallest standard deviation, or larger where that would make too many.
void markInside(const Gaussian<3>& g, double sigmas, Coverage& coverage) {
    constexpr double kMostCellsAlongAnAxis = 24;
    const Eigen::Matrix3d covariance = g.covariance;
    const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
    const Eigen::Vector3d extent = sigmas * covariance.diagonal().cwiseSqrt();
    const double edge = std::max(Eigen::Matrix3d(llt.matrixL()).diagonal().minCoeff(),
                                 2 * extent.maxCoeff() / kMostCellsAlongAnAxis);
    const int octave = octaveOf(std::clamp(edge, 1e-3, 1e3));
    const LatticeCell low = LatticeCell::at(g.mean - extent, octave);
    const LatticeCell high = LatticeCell::at(g.mean + extent, octave);
    for (std::int32_t z = low.z; z <= high.z; ++z)
        for (std::int32_t y = low.y; y <= high.y; ++y)
            for (std::int32_t x = low.x; x <= high.x; ++x) {
                const Eigen::Vector3d centre =
                    (Eigen::Vector3d(x, y, z).array() + 0.5) * powerOfTwo(octave);
                const Eigen::Vector3d offset = centre - g.mean;
                if (llt.matrixL().solve(offset).norm() <= sigmas)
                    coverage.mark(LatticeCell{octave, x, y, z});
            }
}

/// Marks rays that end all over a surface component, as far as its band reached.
void markBand(const Gaussian<3>& g, const ViewDirection& view,
              const OccupancyParams& params, Coverage& coverage) {
    const Eigen::Matrix3d covariance = g.covariance;
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    const Coverage::Rays rays(params.coverage, 0.0, Eigen::Vector3d::Zero());
    constexpr double kSteps[] = {-1.7, -0.85, 0.0, 0.85, 1.7};
    for (const double a : kSteps)
        for (const double b : kSteps)
            for (const double c : kSteps) {
                const Eigen::Vector3d end = g.mean + L * Eigen::Vector3d(a, b, c);
                coverage.markRay(end + params.band.reach(view.range_m) * view.direction,
                                 end, true, rays);
            }
}

}  // namespace

Coverage guessedCoverage(const Mixture<3>& surfaces, const ViewDirections& views,
                         const Mixture<4>& free, const OccupancyParams& params) {
    Coverage coverage;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        if (views[i].known()) markBand(surfaces[i], views[i], params, coverage);
    for (std::size_t i = 0; i < free.size(); ++i) {
        const Gaussian<4> joint = free[i];
        Gaussian<3> place;
        place.mean = joint.mean.head<3>();
        place.covariance = joint.covariance.topLeftCorner<3, 3>();
        markInside(place, params.extentSigmas, coverage);
    }
    return coverage.pruned();
}

}  // namespace hgmm
