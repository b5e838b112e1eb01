#pragma once
#include <hgmm/evaluation/scene.h>
#include <hgmm/evaluation/simulated_sensor.h>

#include <random>
#include <string>
#include <vector>

/// Places whose truth is known, and ways through them. The floor is at -1 m, the sensor at
/// 0, the ceiling at 2 m.
namespace hgmm::slam_studies {

using evaluation::Scene;
using evaluation::SimulatedSensor;
using Waypoints = std::vector<Eigen::Vector2d>;

/// A planar laser of 270 deg, or 16 rings.
SimulatedSensor sensorOf(bool isPlanar);

/// How the furniture of a room differs from that of another one of its size.
enum class Furniture { same, rearranged, halfMoved, halfMissing };

/// Rooms of the same size, each with eight things along its walls and a free middle.
struct FurnishedRoom {
    std::vector<evaluation::Box> things;  ///< the middle of the room is the origin

    static constexpr double kLength_m = 8.0, kWidth_m = 6.0;
    static FurnishedRoom random(std::mt19937_64& random);
    FurnishedRoom changed(Furniture how, std::mt19937_64& random) const;
    Scene scene() const;
};

struct Place {
    Scene scene;
    Waypoints way;
};

/// A corridor with rooms of the same size on both sides, doors opposite each other, and
/// five things in each room that stand elsewhere in each. The way visits all rooms and
/// comes back.
Place lookAlikeRooms(int roomsPerSide, std::mt19937_64& random);

/// Corridors about two blocks, with cupboards at random places; the way is a lap about
/// each.
Place twoLoops(std::mt19937_64& random);

/// Two smooth walls, floor and ceiling, which end where the sensor does not see it.
Place smoothCorridor(double length_m);

/// The same with pillars and niches, at random places every few metres.
Place tunnel(double length_m, std::mt19937_64& random);

}  // namespace hgmm::slam_studies
