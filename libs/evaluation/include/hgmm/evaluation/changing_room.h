#pragma once
#include "hgmm/evaluation/scene.h"

/// The room of the dynamics study: 12 x 10 x 3 m from the origin, a robot on a circle about
/// (6, 5) that looks along +x, a pole and a table before the wall at x = 12. That wall has
/// a doorway of 1 x 2 m, 6 m from the robot, to a corridor of 3 m.
namespace hgmm::evaluation::changing_room {

/// Middle of the robot's circle [m].
inline const Eigen::Vector2d kMiddle{6.0, 5.0};

/// What is behind the things that move.
enum class Background {
    closed,  ///< the wall at x = 12 and the corridor
    open     ///< nothing: rays to that side do not return
};

/// All that stays.
Scene room(Background background);

/// A box of .6 x .6 x 1.2 m on the floor, 2.5 m before the middle.
void addBox(Scene& scene);

/// A cylinder of .25 m radius and 1.7 m height, at y = `y_m`, 2.5 m before the middle.
void addPerson(Scene& scene, double y_m);

/// Where the person is at a scan: it walks to and fro at 1 m/s, 1.5 m to either side, with
/// 10 scans a second [m].
double personAt(int scan);

/// A plate that fills the doorway.
/// @param recess_m its distance behind the face of the wall [m], in [0, .16]
void addDoor(Scene& scene, double recess_m);

/// A partition of 2 x 2 m, 3 m before the middle.
void addPartition(Scene& scene);

}  // namespace hgmm::evaluation::changing_room
