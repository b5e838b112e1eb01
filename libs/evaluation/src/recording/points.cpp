#include "hgmm/evaluation/points.h"

#include <cmath>
#include <stdexcept>

namespace hgmm::evaluation {

void appendPoints(const Scan& scan, const std::vector<std::size_t>& indices,
                  Points& points_map) {
    points_map.reserve(points_map.size() + indices.size());
    for (const std::size_t i : indices) {
        const Eigen::Vector3d p_sensor(scan.x[i], scan.y[i], scan.z[i]);
        if (!p_sensor.allFinite()) continue;
        points_map.push_back(scan.T_map_sensor.R * p_sensor + scan.T_map_sensor.t);
    }
}

Box boundingBox(const Points& points) {
    if (points.empty()) throw std::invalid_argument("boundingBox: there are no points");
    Box box{points.front(), points.front()};
    for (const Eigen::Vector3d& p : points) {
        box.low = box.low.cwiseMin(p);
        box.high = box.high.cwiseMax(p);
    }
    return box;
}

}  // namespace hgmm::evaluation
