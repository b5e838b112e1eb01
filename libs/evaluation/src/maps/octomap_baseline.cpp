#include "maps/octomap_baseline.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cmath>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "maps/octree_access.h"

namespace hgmm::evaluation {

OctomapBaseline::OctomapBaseline(double resolution_m) : map_(resolution_m) {
    // MRPT hands this flag to octomap as `lazy_eval`: true would leave the tree unpruned
    // and its inner nodes out of date.
    map_.insertionOptions.pruning = false;
}

std::string OctomapBaseline::source() const {
    return "Hornung et al., OctoMap, Autonomous Robots 2013";
}

std::vector<std::pair<std::string, double>> OctomapBaseline::options() const {
    return optionsOfOctree(map_);
}

void OctomapBaseline::insert(const Scan& scan) {
    // The octree behind COctoMap cannot be reached, and COctoMap::insertPointCloud updates
    // a voxel once for each ray instead of once for each scan. Its path for observations
    // calls octomap's own insertPointCloud, but forgets the sensor's pose on the robot: so
    // the sensor is the robot here.
    mrpt::obs::CObservation3DRangeScan observation;
    observation.hasPoints3D = true;
    observation.resizePoints3DVectors(scan.size());
    std::size_t n = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        if (!std::isfinite(scan.x[i] + scan.y[i] + scan.z[i])) continue;
        observation.points3D_x[n] = scan.x[i];
        observation.points3D_y[n] = scan.y[i];
        observation.points3D_z[n] = scan.z[i];
        ++n;
    }
    observation.resizePoints3DVectors(n);
    map_.insertObservation(observation, mrpt_bridge::toCPose3D(scan.T_map_sensor));
}

void OctomapBaseline::query(const Eigen::Vector3d* points_map, std::size_t n,
                            Answer* answers) const {
    for (std::size_t i = 0; i < n; ++i) answers[i] = answerOfOctree(map_, points_map[i]);
}

}  // namespace hgmm::evaluation
