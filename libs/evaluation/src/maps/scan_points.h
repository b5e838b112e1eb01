#pragma once
#include <cmath>

#include "hgmm/evaluation/points.h"

namespace hgmm::evaluation {

/// The finite points of a scan, in the map frame [m].
inline Points finitePointsInMap(const Scan& scan) {
    Points points;
    points.reserve(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const Eigen::Vector3d p_sensor(scan.x[i], scan.y[i], scan.z[i]);
        if (p_sensor.allFinite())
            points.push_back(scan.T_map_sensor.R * p_sensor + scan.T_map_sensor.t);
    }
    return points;
}

}  // namespace hgmm::evaluation
