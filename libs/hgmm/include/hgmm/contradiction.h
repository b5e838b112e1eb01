#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hgmm/lattice.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// What becomes of a surface that rays pass through.
struct ContradictionParams {
    /// Share of its support that a component keeps each time a scan saw through it [1], in
    /// (0, 1]; 1 = rays never remove surfaces.
    double contradictedKeep = 0.25;
    /// A component with less support is dropped, new ones included [count], >= 0.
    double minSupport = 0.5;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// The nearest range that a scan measured in each direction, on the faces of a cube around
/// the sensor.
class RangeImage {
 public:
    /// @param samples of one scan, in the frame of `origin`
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

/// Component means in a coarse grid: who lies within a box.
class CoarseGrid {
 public:
    /// Enters or moves component i, which must be < size() or the next one.
    void update(std::uint32_t i, const Eigen::Vector3d& mean);
    /// Follows Mixture::removeSwap(i).
    void removeSwap(std::uint32_t i);
    /// Components in the cells that touch the box, rising.
    std::vector<std::uint32_t> within(const Eigen::Vector3d& low,
                                      const Eigen::Vector3d& high) const;
    std::size_t size() const { return cellOf_.size(); }
    std::size_t liveBytes() const;

 private:
    static constexpr int kOctave = 3;  // 8 m
    void leave(std::uint32_t i);

    std::vector<LatticeCell> cellOf_;
    std::unordered_map<LatticeCell, std::vector<std::uint32_t>, LatticeCellHash> members_;
};

}  // namespace hgmm
