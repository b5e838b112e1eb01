#include "hgmm/evaluation/solid_room.h"

#include <Eigen/Geometry>
#include <cmath>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation::solid_room {
namespace {

const Eigen::Vector3d kSize{12.0, 8.0, 3.0};  ///< [m]
constexpr double kFromFaces_m = 0.04, kBehindLeast_m = 0.15, kBehindMost_m = 1.6;
constexpr double kTurn = 6.283185307179586;  ///< [rad]
constexpr double kSensor_m = 1.0;            ///< height

struct SolidBox {
    const char* kind;
    double edge_m;
    Eigen::Vector2d middle;  ///< [m]
};

const SolidBox kBoxes[] = {
    {"box .2", 0.2, {6.0, 5.6}}, {"box .5", 0.5, {3.5, 4.0}}, {"box 1.2", 1.2, {8.5, 4.5}}};
const Pillar kPillars[] = {{{2.4, 3.2}, 0.1, 0.0, 3.0},
                           {{6.0, 2.2}, 0.15, 0.0, 3.0},
                           {{10.3, 6.5}, 0.2, 0.0, 3.0}};

/// Draws numbers for points.
class Drawing {
 public:
    Drawing(double height_m, std::uint64_t seed)
        : height_m_(height_m), stream_(randomStream(seed, 0, Draw::unseen)) {}

    double between(double low, double high) {
        return low + nextUniform(stream_) * (high - low);
    }
    double height() {
        const double any_m = between(kFromFaces_m, kSize.z() - kFromFaces_m);
        return height_m_ > 0.0 ? height_m_ : any_m;
    }
    double behind() { return between(kBehindLeast_m, kBehindMost_m); }

 private:
    double height_m_;
    std::mt19937_64 stream_;
};

Eigen::Vector3d insideOf(const SolidBox& b, Drawing& drawing) {
    const double half_m = 0.5 * b.edge_m - kFromFaces_m;
    const double x = b.middle.x() + drawing.between(-half_m, half_m);
    const double y = b.middle.y() + drawing.between(-half_m, half_m);
    return {x, y, drawing.height()};
}

Eigen::Vector3d insideOf(const Pillar& p, Drawing& drawing) {
    const double radius_m = (p.radius_m - kFromFaces_m) * std::sqrt(drawing.between(0, 1));
    const double angle = drawing.between(0, kTurn);
    return {p.axis.x() + radius_m * std::cos(angle),
            p.axis.y() + radius_m * std::sin(angle), drawing.height()};
}

/// Behind the i-th of the four walls.
Eigen::Vector3d behindWall(std::size_t i, Drawing& drawing) {
    const int across = i % 2 == 0 ? 0 : 1, along = 1 - across;
    const double behind_m = drawing.behind();
    Eigen::Vector3d p;
    p[across] = i % 4 < 2 ? -behind_m : kSize[across] + behind_m;
    p[along] = drawing.between(0.0, kSize[along]);
    p.z() = drawing.height();
    return p;
}

/// Beyond the i-th of the four corners.
Eigen::Vector3d beyondCorner(std::size_t i, Drawing& drawing) {
    const double x = drawing.behind(), y = drawing.behind();
    return {i % 2 == 0 ? -x : kSize.x() + x, i % 4 < 2 ? -y : kSize.y() + y,
            drawing.height()};
}

}  // namespace

Scene room() {
    constexpr double kThick_m = 2.0;
    const Eigen::Vector3d low = Eigen::Vector3d::Constant(-kThick_m);
    const Eigen::Vector3d high = kSize.array() + kThick_m;
    Scene scene;
    for (int axis = 0; axis < 3; ++axis) {
        Box before{low, high}, after{low, high};
        before.high[axis] = 0.0;
        after.low[axis] = kSize[axis];
        scene.add(before, axis == 2 ? Part::floor : Part::wall);
        scene.add(after, axis == 2 ? Part::ceiling : Part::wall);
    }
    for (const SolidBox& b : kBoxes) {
        const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5 * b.edge_m);
        const Eigen::Vector2d lowest = b.middle - half, highest = b.middle + half;
        scene.add(Box{{lowest.x(), lowest.y(), 0.0}, {highest.x(), highest.y(), kSize.z()}},
                  Part::solid);
    }
    for (const Pillar& p : kPillars) scene.add(p, Part::solid);
    return scene;
}

std::vector<HiddenPoints> hiddenPoints(std::size_t n, double height_m, std::uint64_t seed) {
    Drawing drawing(height_m, seed);
    std::vector<HiddenPoints> all;
    const auto add = [&](const char* kind, auto draw) {
        HiddenPoints& hidden = all.emplace_back();
        hidden.kind = kind;
        for (std::size_t i = 0; i < n; ++i) hidden.points_map.push_back(draw(i));
    };
    for (const SolidBox& b : kBoxes)
        add(b.kind, [&](std::size_t) { return insideOf(b, drawing); });
    add("pillars", [&](std::size_t i) { return insideOf(kPillars[i % 3], drawing); });
    add("behind walls", [&](std::size_t i) { return behindWall(i, drawing); });
    add("beyond corners", [&](std::size_t i) { return beyondCorner(i, drawing); });
    return all;
}

std::vector<Pose> poses(Route route, int scans) {
    std::vector<Pose> all;
    for (int i = 0; i < scans; ++i) {
        Eigen::Vector2d at, towards;
        if (route == Route::round) {
            const double angle = kTurn * i / scans;
            at << 6.0 + 4.4 * std::cos(angle), 4.0 + 3.2 * std::sin(angle);
            towards = Eigen::Vector2d(6.0, 4.0) - at;
        } else {
            const double share = scans > 1 ? i / (scans - 1.0) : 0.0;
            at << 1.0 + 10.0 * share, 4.0 + 2.8 * std::sin(kTurn * share);
            towards << 10.0, 2.8 * kTurn * std::cos(kTurn * share);
        }
        Pose pose;
        pose.R = Eigen::AngleAxisd(std::atan2(towards.y(), towards.x()),
                                   Eigen::Vector3d::UnitZ())
                     .toRotationMatrix();
        pose.t << at.x(), at.y(), kSensor_m;
        all.push_back(pose);
    }
    return all;
}

}  // namespace hgmm::evaluation::solid_room
