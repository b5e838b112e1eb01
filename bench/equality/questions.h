#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/map.h"

namespace equality {

/// Splitmix64: the same numbers with any library and compiler.
class Generator {
 public:
    explicit Generator(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next();
    std::size_t below(std::size_t n) { return next() % n; }  ///< in [0, n), n > 0
    double uniform(double low, double high);                 ///< in [low, high)
    /// Mean 0, standard deviation 1: the sum of twelve uniform numbers.
    double aboutNormal();
    Eigen::Vector3d inCube(double halfEdge);

 private:
    std::uint64_t state_;
};

/// A ray from a sensor's place to about a surface.
struct Ray {
    Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();     ///< [m]
    Eigen::Vector3d direction_map = Eigen::Vector3d::Zero();  ///< of any length
};

/// Where a map is asked.
struct Questions {
    /// In turns: anywhere in the box around the map, near a surface, and on a ray between
    /// sensor and surface or just behind it [m].
    std::vector<Eigen::Vector3d> points_map;
    std::vector<Ray> rays_map;

    /// Every step-th of the points.
    std::vector<Eigen::Vector3d> everyPoint(std::size_t step) const;
    /// Every step-th of the points and of the rays.
    Questions every(std::size_t step) const;
};

/// Draws questions from a map's surfaces and the places of its sensors.
Questions questionsFor(const hgmm::Map& map,
                       const std::vector<Eigen::Vector3d>& sensors_map);

}  // namespace equality
