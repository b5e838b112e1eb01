#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "hgmm/evaluation/points.h"

namespace hgmm::evaluation {

/// What a surface of a scene belongs to: figures are taken for each.
enum class Part { wall, floor, ceiling, pole, tableTop, solid, moving };

/// A cylinder that stands upright.
struct Pillar {
    Eigen::Vector2d axis;  ///< where it stands [m]
    double radius_m;       ///< [m], > 0
    double bottom_m;       ///< height of its lower end [m]
    double top_m;          ///< height of its upper end [m], > bottom_m
};

/// Where a ray enters the first solid.
struct SceneHit {
    double range_m = std::numeric_limits<double>::infinity();  ///< from the origin [m]
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, outwards, unit
    Part part = Part::wall;
};

/// A world of solid boxes along the axes and upright cylinders, whose ray casts and
/// distances are exact. Const member functions may be called from several threads at once.
class Scene {
 public:
    /// Throws std::invalid_argument unless low < high on each axis.
    void add(const Box& box, Part part);
    /// Throws std::invalid_argument unless radius and height are positive.
    void add(const Pillar& pillar, Part part);

    /// The nearest solid that a ray enters; nothing if it enters none. Solids that hold the
    /// origin are not seen.
    /// @param direction of unit length
    std::optional<SceneHit> cast(const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction) const;

    /// Distance to the nearest solid whose part is accepted by `counts`; 0 inside, infinity
    /// if there is none [m].
    template <class Counts>
    double distance(const Eigen::Vector3d& point, const Counts& counts) const {
        double nearest_m = std::numeric_limits<double>::infinity();
        for (const PartBox& b : boxes_)
            if (counts(b.part)) nearest_m = std::min(nearest_m, distanceTo(b.box, point));
        for (const PartPillar& p : pillars_)
            if (counts(p.part))
                nearest_m = std::min(nearest_m, distanceTo(p.pillar, point));
        return nearest_m;
    }

 private:
    struct PartBox {
        Box box;
        Part part;
    };
    struct PartPillar {
        Pillar pillar;
        Part part;
    };

    static double distanceTo(const Box& box, const Eigen::Vector3d& point);
    static double distanceTo(const Pillar& pillar, const Eigen::Vector3d& point);

    std::vector<PartBox> boxes_;
    std::vector<PartPillar> pillars_;
};

}  // namespace hgmm::evaluation
