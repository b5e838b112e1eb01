#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// Points in the map frame [m], in double: maps may lie far from the origin.
using Points = std::vector<Eigen::Vector3d>;

/// Appends the finite points of a scan that are named by `indices`, in the map frame.
void appendPoints(const Scan& scan, const std::vector<std::size_t>& indices,
                  Points& points_map);

/// Smallest axis-aligned box around points.
struct Box {
    Eigen::Vector3d low;   ///< [m]
    Eigen::Vector3d high;  ///< [m]

    double volume() const { return (high - low).prod(); }
};

/// Throws std::invalid_argument if there are no points.
Box boundingBox(const Points& points);

}  // namespace hgmm::evaluation
