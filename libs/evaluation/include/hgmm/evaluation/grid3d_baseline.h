#pragma once
#include <mrpt/maps/COccupancyGridMap3D.h>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// MRPT's dense grid of voxels with its default sensor model, which grows to hold each
/// scan: MRPT's own insertion leaves out what is beyond its borders.
class Grid3dBaseline : public Baseline {
 public:
    /// Voxels that the grid may grow to [1].
    static constexpr double kMaxVoxels = 2.0e9;

    /// @param resolution_m edge of a voxel [m], > 0
    explicit Grid3dBaseline(double resolution_m) : edge_m_(resolution_m) {}

    std::string className() const override { return "mrpt::maps::COccupancyGridMap3D"; }
    std::string source() const override;
    std::vector<std::pair<std::string, double>> options() const override;
    /// Throws std::runtime_error if the grid would have more than kMaxVoxels.
    void insert(const Scan& scan) override;
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override;
    std::size_t liveBytes() const override;
    std::optional<std::size_t> serializedBytes() const override;

 private:
    double edge_m_;
    bool empty_ = true;
    mrpt::maps::COccupancyGridMap3D map_;

    void growToHold(const Eigen::Vector3d& low_map, const Eigen::Vector3d& high_map);
};

}  // namespace hgmm::evaluation
