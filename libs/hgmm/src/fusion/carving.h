#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/params.h"
#include "index/coarse_grid.h"

namespace hgmm {

/// The nearest range that a scan measured in each direction, on the faces of a cube around
/// the sensor.
class RangeImage {
 public:
    /// @param samples of one scan, where its rays end, in the frame of `origin`
    RangeImage(const Mixture<3>& samples, const Eigen::Vector3d& origin);

    /// The nearest measurement in the bin of a direction and the bins beside it [m]; 0
    /// where there is none in its own bin.
    float nearestRange(const Eigen::Vector3d& direction) const;

 private:
    static constexpr int kBins = 45;  // an axis of a face: 2 degrees
    struct Bin {
        int face, row, col;
    };
    static Bin binOf(const Eigen::Vector3d& direction);
    float at(int face, int row, int col) const {
        return ranges_[static_cast<std::size_t>((face * kBins + row) * kBins + col)];
    }

    std::vector<float> ranges_;
};

/// Whether a scan from `origin` saw through a component: rays at its mean and at most of
/// its sigma points end more than three of its standard deviations behind it.
bool isSeenThrough(const Gaussian<3>& component, const RangeImage& image,
                   const Eigen::Vector3d& origin);

/// Components that a scan saw through, rising; none if params.carvedSupport is 1.
/// @param samples where its rays end, in the frame of the surfaces and of `sensorOrigin`
/// @param grid of the surfaces' means
std::vector<std::uint32_t> seenThrough(const Mixture<3>& surfaces,
                                       const Mixture<3>& samples,
                                       const Eigen::Vector3d& sensorOrigin,
                                       const CoarseGrid& grid, const CarvingParams& params);

}  // namespace hgmm
