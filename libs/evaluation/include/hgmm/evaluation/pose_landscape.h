#pragma once
#include <Eigen/Core>
#include <functional>
#include <random>

#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// How far a pose is from another.
struct PoseError {
    double position_m = 0.0;    ///< [m], >= 0
    double rotation_deg = 0.0;  ///< angle of the rotation between them [deg], 0 to 180
};

PoseError errorOf(const Pose& estimate, const Pose& truth);

/// A pose `distance_m` and `angle_deg` away, in directions drawn evenly; planar: x, y and
/// yaw only.
Pose displaced(const Pose& pose, double distance_m, double angle_deg, bool planar,
               std::mt19937_64& stream);

/// What rates poses: higher is better. Called from several threads at once.
using PoseScore = std::function<double(const Pose&)>;

/// How a score is searched.
struct PoseSearch {
    bool planar = false;        ///< x, y and yaw only
    double lever_m = 1.0;       ///< rotations by a / lever_m count as steps of a [m], > 0
    double firstStep_m = 0.1;   ///< of a climb, and between nodes of a lattice [m], > 0
    double lastStep_m = 0.002;  ///< of a climb [m], > 0
    /// Climbs also turn about this point [m], in the frame of the pose, unless it is zero:
    /// if what a pose places is all before it, as what a depth camera saw, turning about
    /// the pose itself moves all of it aside.
    Eigen::Vector3d pivot = Eigen::Vector3d::Zero();
};

/// The pose at which a pattern search (Hooke and Jeeves 1961) ends: along the axes of the
/// map and about those of the pose, through the pivot, too, in steps that are halved where
/// none leads up, and in strides along what led up before. Uses nothing but values of the
/// score.
Pose climb(const PoseScore& score, const Pose& start, const PoseSearch& search);

/// The highest pose found around `centre`: all nodes of a lattice that spans +-reach_m in
/// each direction and +-reach_deg about each axis are rated, and the best kClimbed of them
/// climbed. `centre` itself is not a node: the lattice is shifted by random fractions of a
/// step. Does not depend on the number of threads.
Pose highestAround(const PoseScore& score, const Pose& centre, double reach_m,
                   double reach_deg, const PoseSearch& search, std::mt19937_64& stream);

constexpr int kClimbed = 16;

}  // namespace hgmm::evaluation
