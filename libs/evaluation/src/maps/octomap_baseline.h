#pragma once
#include <mrpt/maps/COctoMap.h>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// MRPT's octree of voxels with OctoMap's default sensor model. Its octree is pruned after
/// each scan, as the octomap library does by default.
class OctomapBaseline : public Baseline {
 public:
    /// @param resolution_m edge of a voxel [m], > 0
    explicit OctomapBaseline(double resolution_m);

    std::string className() const override { return "mrpt::maps::COctoMap"; }
    std::string source() const override;
    std::vector<std::pair<std::string, double>> options() const override;
    void insert(const Scan& scan) override;
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override;
    std::size_t liveBytes() const override { return map_.memoryUsage(); }

 private:
    mrpt::maps::COctoMap map_;
};

}  // namespace hgmm::evaluation
