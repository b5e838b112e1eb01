#include "hgmm/evaluation/changing_room.h"

#include <cmath>

namespace hgmm::evaluation::changing_room {
namespace {

constexpr double kLength_m = 12.0, kWidth_m = 10.0, kHeight_m = 3.0;  ///< of the room
constexpr double kThick_m = 0.2;                                      ///< of walls
constexpr double kCorridor_m = 3.0;                                   ///< its width
constexpr double kDoorLeft_m = 4.5, kDoorRight_m = 5.5, kDoorHeight_m = 2.0;
constexpr double kDoorThick_m = 0.04;
constexpr double kBefore_m = 2.5;   ///< of box and person from the middle
constexpr double kWalk_m = 3.0;     ///< the person's way from end to end
constexpr double kPerScan_m = 0.1;  ///< of it

Box box(double x0, double y0, double z0, double x1, double y1, double z1) {
    return {{x0, y0, z0}, {x1, y1, z1}};
}

/// The wall with the doorway, and the corridor behind it.
void addFarSide(Scene& scene) {
    const double face = kLength_m, back = kLength_m + kThick_m;
    const double end = back + kCorridor_m;
    scene.add(box(face, 0, 0, back, kDoorLeft_m, kHeight_m), Part::wall);
    scene.add(box(face, kDoorRight_m, 0, back, kWidth_m, kHeight_m), Part::wall);
    scene.add(box(face, kDoorLeft_m, kDoorHeight_m, back, kDoorRight_m, kHeight_m),
              Part::wall);
    scene.add(box(end, 0, 0, end + kThick_m, kWidth_m, kHeight_m), Part::wall);
    scene.add(box(face, -kThick_m, 0, end, 0, kHeight_m), Part::wall);
    scene.add(box(face, kWidth_m, 0, end, kWidth_m + kThick_m, kHeight_m), Part::wall);
    scene.add(box(face, 0, -kThick_m, end, kWidth_m, 0), Part::floor);
    scene.add(box(face, 0, kHeight_m, end, kWidth_m, kHeight_m + kThick_m), Part::ceiling);
}

}  // namespace

Scene room(Background background) {
    const double t = kThick_m;
    Scene scene;
    scene.add(box(0, 0, -t, kLength_m, kWidth_m, 0), Part::floor);
    scene.add(box(0, 0, kHeight_m, kLength_m, kWidth_m, kHeight_m + t), Part::ceiling);
    scene.add(box(-t, 0, 0, 0, kWidth_m, kHeight_m), Part::wall);
    scene.add(box(0, -t, 0, kLength_m, 0, kHeight_m), Part::wall);
    scene.add(box(0, kWidth_m, 0, kLength_m, kWidth_m + t, kHeight_m), Part::wall);
    if (background == Background::closed) addFarSide(scene);
    scene.add(Pillar{{10.0, 6.6}, 0.02, 0.0, kHeight_m}, Part::pole);
    scene.add(box(9.2, 2.8, 0.72, 10.4, 3.8, 0.75), Part::tableTop);
    return scene;
}

void addBox(Scene& scene) {
    const double x = kMiddle.x() + kBefore_m, y = kMiddle.y();
    scene.add(box(x, y - 0.3, 0.0, x + 0.6, y + 0.3, 1.2), Part::moving);
}

void addPerson(Scene& scene, double y_m) {
    scene.add(Pillar{{kMiddle.x() + kBefore_m, y_m}, 0.25, 0.0, 1.7}, Part::moving);
}

double personAt(int scan) {
    const double way_m = std::fmod(kPerScan_m * scan, 2.0 * kWalk_m);
    return kMiddle.y() - 0.5 * kWalk_m + std::min(way_m, 2.0 * kWalk_m - way_m);
}

void addDoor(Scene& scene, double recess_m) {
    const double face = kLength_m + recess_m;
    scene.add(box(face, kDoorLeft_m, 0.0, face + kDoorThick_m, kDoorRight_m, kDoorHeight_m),
              Part::moving);
}

void addPartition(Scene& scene) {
    const double x = kMiddle.x() + 3.0, y = kMiddle.y();
    scene.add(box(x, y - 1.0, 0.0, x + 0.1, y + 1.0, 2.0), Part::moving);
}

}  // namespace hgmm::evaluation::changing_room
