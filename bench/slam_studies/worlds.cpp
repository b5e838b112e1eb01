#include "worlds.h"

#include <algorithm>

namespace hgmm::slam_studies {
namespace {

using evaluation::Box;
using evaluation::Part;

constexpr double kFloor_m = -1.0, kCeiling_m = 2.0, kWall_m = 0.2;

void addUpright(Scene& scene, double x0, double y0, double x1, double y1,
                Part part = Part::wall) {
    scene.add(Box{{x0, y0, kFloor_m}, {x1, y1, kCeiling_m}}, part);
}

void addFloorAndCeiling(Scene& scene, double x0, double y0, double x1, double y1) {
    scene.add(Box{{x0, y0, kFloor_m - 0.5}, {x1, y1, kFloor_m}}, Part::floor);
    scene.add(Box{{x0, y0, kCeiling_m}, {x1, y1, kCeiling_m + 0.5}}, Part::ceiling);
}

/// The four walls around an area.
void addWallsAround(Scene& scene, double x0, double y0, double x1, double y1) {
    addUpright(scene, x0 - kWall_m, y0 - kWall_m, x1 + kWall_m, y0);
    addUpright(scene, x0 - kWall_m, y1, x1 + kWall_m, y1 + kWall_m);
    addUpright(scene, x0 - kWall_m, y0, x0, y1);
    addUpright(scene, x1, y0, x1 + kWall_m, y1);
    addFloorAndCeiling(scene, x0, y0, x1, y1);
}

double between(double low, double high, std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

void addPillar(Scene& scene, double x, double y, std::mt19937_64& random) {
    scene.add(evaluation::Pillar{{x, y}, between(0.08, 0.25, random), kFloor_m, kCeiling_m},
              Part::pole);
}

/// One thing of a room, at one of its long walls.
Box randomThing(double side, std::mt19937_64& random) {
    const double half = between(0.15, 0.4, random);
    const double x = between(-3.3, 3.3, random);
    const double y = side * between(1.6, 2.5, random);
    return {{x - half, y - half, kFloor_m},
            {x + half, y + half, kFloor_m + between(1.5, 3.0, random)}};
}

/// A room beside a corridor of 2 m along x, its door in the middle.
void addRoomBeside(Scene& scene, double x0, double length_m, double side,
                   std::mt19937_64& random) {
    constexpr double kDoor_m = 1.2, kDeep_m = 5.0;
    const auto add = [&](double xa, double ya, double xb, double yb, Part part) {
        addUpright(scene, xa, std::min(side * ya, side * yb), xb,
                   std::max(side * ya, side * yb), part);
    };
    const double middle = x0 + length_m / 2;
    add(x0, 1.0, middle - kDoor_m / 2, 1.0 + kWall_m, Part::wall);
    add(middle + kDoor_m / 2, 1.0, x0 + length_m, 1.0 + kWall_m, Part::wall);
    add(x0, 1.0 + kDeep_m, x0 + length_m, 1.0 + kDeep_m + kWall_m, Part::wall);
    for (const double x : {x0, x0 + length_m})
        add(x - kWall_m / 2, 1.0, x + kWall_m / 2, 1.0 + kDeep_m, Part::wall);
    for (int k = 0; k < 5; ++k) {
        const double x = middle + (k % 2 == 0 ? 1 : -1) * between(1.3, 2.4, random);
        const double y = between(1.8, 5.4, random), half = between(0.15, 0.45, random);
        add(x - half, y - half, x + half, y + half, Part::solid);
    }
}

/// Cupboards along a wall from `from` to `to`, at random places.
/// @param out where the corridor is: 1 for larger coordinates across the wall
void furnishWall(Scene& scene, bool isAlongX, double from, double to, double across,
                 double out, std::mt19937_64& random) {
    for (double at = from + between(0.5, 3.0, random); at < to - 3.0;
         at += between(3.0, 7.0, random)) {
        const double end = at + between(0.4, 2.5, random);
        const double deep = across + out * between(0.15, 0.5, random);
        const double low = std::min(across, deep), high = std::max(across, deep);
        if (isAlongX)
            addUpright(scene, at, low, end, high, Part::solid);
        else
            addUpright(scene, low, at, high, end, Part::solid);
    }
}

}  // namespace

SimulatedSensor sensorOf(bool isPlanar) {
    return isPlanar ? evaluation::planarLaser(361, 270.0, 20.0)
                    : evaluation::ringLidar(16, -15.0, 15.0, 240, 50.0);
}

FurnishedRoom FurnishedRoom::random(std::mt19937_64& random) {
    FurnishedRoom room;
    for (int k = 0; k < 8; ++k)
        room.things.push_back(randomThing(k % 2 == 0 ? 1.0 : -1.0, random));
    return room;
}

FurnishedRoom FurnishedRoom::changed(Furniture how, std::mt19937_64& random) const {
    FurnishedRoom other = *this;
    if (how == Furniture::rearranged) return FurnishedRoom::random(random);
    if (how == Furniture::halfMissing) other.things.resize(things.size() / 2);
    if (how == Furniture::halfMoved)
        for (std::size_t k = 0; k < things.size() / 2; ++k)
            other.things[k] = randomThing(k % 2 == 0 ? 1.0 : -1.0, random);
    return other;
}

Scene FurnishedRoom::scene() const {
    Scene scene;
    addWallsAround(scene, -kLength_m / 2, -kWidth_m / 2, kLength_m / 2, kWidth_m / 2);
    for (const Box& thing : things) scene.add(thing, Part::solid);
    return scene;
}

Place lookAlikeRooms(int roomsPerSide, std::mt19937_64& random) {
    constexpr double kRoom_m = 6.0;
    const double length_m = kRoom_m * roomsPerSide;
    Place place;
    addFloorAndCeiling(place.scene, 0, -7, length_m, 7);
    for (const double x : {-kWall_m, length_m})
        addUpright(place.scene, x, -7, x + kWall_m, 7);
    place.way.push_back({1.0, 0.0});
    for (int k = 0; k < roomsPerSide; ++k) {
        const double middle = (k + 0.5) * kRoom_m;
        for (const double side : {1.0, -1.0}) {
            addRoomBeside(place.scene, k * kRoom_m, kRoom_m, side, random);
            for (const double y : {0.0, side * 3.5, 0.0}) place.way.push_back({middle, y});
        }
    }
    place.way.push_back({length_m - 1.0, 0.0});
    place.way.push_back({1.0, 0.0});
    return place;
}

Place twoLoops(std::mt19937_64& random) {
    constexpr double kLong = 40.0, kHigh = 22.0, kMid = 15.0, kWide = 2.4;
    Place place;
    Scene& scene = place.scene;
    addWallsAround(scene, 0, 0, kLong, kHigh);
    addUpright(scene, kWide, kWide, kMid, kHigh - kWide);
    addUpright(scene, kMid + kWide, kWide, kLong - kWide, kHigh - kWide);
    const double right = kLong - kWide, top = kHigh - kWide;
    for (const auto& [y, out] :
         {std::pair{0.0, 1.0}, {kWide, -1.0}, {top, 1.0}, {kHigh, -1.0}})
        furnishWall(scene, true, 0, kLong, y, out, random);
    for (const auto& [x, out] : {std::pair{0.0, 1.0},
                                 {kWide, -1.0},
                                 {kMid, 1.0},
                                 {kMid + kWide, -1.0},
                                 {right, 1.0},
                                 {kLong, -1.0}})
        furnishWall(scene, false, kWide, top, x, out, random);
    const double half = kWide / 2, x1 = kMid + half, x2 = kLong - half, y2 = kHigh - half;
    place.way = {{half, half}, {x1, half}, {x1, y2}, {half, y2}, {half, half}, {x1, half},
                 {x2, half},   {x2, y2},   {x1, y2}, {x1, half}, {half, half}};
    return place;
}

Place smoothCorridor(double length_m) {
    Place place;
    constexpr double kBeyond_m = 60.0;
    addFloorAndCeiling(place.scene, -kBeyond_m, -1.2, length_m + kBeyond_m, 1.2);
    for (const double y : {-1.2, 1.0})
        addUpright(place.scene, -kBeyond_m, y, length_m + kBeyond_m, y + kWall_m);
    place.way = {{0, 0}, {length_m, 0}};
    return place;
}

Place tunnel(double length_m, std::mt19937_64& random) {
    Place place;
    constexpr double kHalf_m = 2.0, kEnds_m = 10.0;
    addWallsAround(place.scene, -kEnds_m, -kHalf_m, length_m + kEnds_m, kHalf_m);
    for (double x = -kEnds_m; x < length_m + kEnds_m; x += between(3.0, 8.0, random)) {
        const double side = random() % 2 == 0 ? 1.0 : -1.0;
        if (random() % 2 == 0) {
            addPillar(place.scene, x, side * kHalf_m, random);
            continue;
        }
        const double deep_m = between(0.1, 0.6, random), y = side * kHalf_m;
        addUpright(place.scene, x, std::min(y, y - side * deep_m),
                   x + between(0.3, 1.5, random), std::max(y, y - side * deep_m));
    }
    place.way = {{0, 0}, {length_m, 0}};
    return place;
}

}  // namespace hgmm::slam_studies
