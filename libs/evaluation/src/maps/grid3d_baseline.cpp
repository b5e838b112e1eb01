#include "hgmm/evaluation/grid3d_baseline.h"

#include <cmath>
#include <stdexcept>

#include "maps/grid3d_access.h"
#include "maps/scan_points.h"
#include "maps/serialized_size.h"

namespace hgmm::evaluation {

std::string Grid3dBaseline::source() const {
    return "MRPT's dense grid; Moravec and Elfes, High resolution maps from wide angle "
           "sonar, ICRA 1985, in 3D";
}

std::vector<std::pair<std::string, double>> Grid3dBaseline::options() const {
    return {
        {"resolution", edge_m_},
        {"maxOccupancyUpdateCertainty", map_.insertionOptions.maxOccupancyUpdateCertainty},
        {"maxFreenessUpdateCertainty", map_.insertionOptions.maxFreenessUpdateCertainty}};
}

void Grid3dBaseline::growToHold(const Eigen::Vector3d& low_map,
                                const Eigen::Vector3d& high_map) {
    // Borders at multiples of the edge, so that growing never moves a voxel; one voxel
    // more, as coordinates are rounded to float on the way.
    Eigen::Array3d low = ((low_map.array() / edge_m_).floor() - 1.0) * edge_m_;
    Eigen::Array3d high = ((high_map.array() / edge_m_).floor() + 2.0) * edge_m_;
    const auto& g = map_.m_grid;
    if (!empty_) {
        low = low.min(Eigen::Array3d(g.getXMin(), g.getYMin(), g.getZMin()));
        high = high.max(Eigen::Array3d(g.getXMax(), g.getYMax(), g.getZMax()));
    }
    if (((high - low) / edge_m_).prod() > kMaxVoxels)
        throw std::runtime_error(
            "grid3d: the scans span more voxels than a dense grid may have; give a coarser "
            "resolution than " +
            std::to_string(edge_m_) + " m");
    const mrpt::math::TPoint3D lowCorner(low[0], low[1], low[2]);
    const mrpt::math::TPoint3D highCorner(high[0], high[1], high[2]);
    if (empty_)
        map_.setSize(lowCorner, highCorner, edge_m_);
    else
        map_.resizeGrid(lowCorner, highCorner);
    empty_ = false;
}

void Grid3dBaseline::insert(const Scan& scan) {
    const Points points = finitePointsInMap(scan);
    if (points.empty()) return;
    Box box = boundingBox(points);
    box.low = box.low.cwiseMin(scan.T_map_sensor.t);
    box.high = box.high.cwiseMax(scan.T_map_sensor.t);
    growToHold(box.low, box.high);
    insertIntoGrid(points, scan.T_map_sensor.t, map_);
}

void Grid3dBaseline::query(const Eigen::Vector3d* points_map, std::size_t n,
                           Answer* answers) const {
    for (std::size_t i = 0; i < n; ++i)
        answers[i] = empty_ ? Answer{} : answerOfGrid(map_, points_map[i]);
}

std::size_t Grid3dBaseline::liveBytes() const {
    return empty_ ? 0 : bytesOfGrid(map_);
}

std::optional<std::size_t> Grid3dBaseline::serializedBytes() const {
    return serializedSize(map_);
}

}  // namespace hgmm::evaluation
