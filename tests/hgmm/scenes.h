#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/map.h"
#include "room_scanner.h"

namespace hgmm::testing {

/// An empty room, 8 m x 6 m x 2.5 m, walls at x = +-4 and y = +-3.
inline RoomScanner emptyRoom() {
    RoomScanner scanner;
    scanner.furniture.clear();
    scanner.elevations = 48;
    scanner.elevationSpan_rad = 1.4;
    return scanner;
}

/// The same room with one thing in it.
inline RoomScanner roomWith(const Box& thing) {
    RoomScanner scanner = emptyRoom();
    scanner.furniture.push_back(thing);
    return scanner;
}

/// A walk around the middle of the room, 1 m to 1.5 m from it: pose k.
inline Pose walk(int k, double radius = 1.2) {
    const double a = 0.7 * k;
    return poseAt(radius * std::cos(a), radius * std::sin(a), 1.0 + 0.05 * (k % 5),
                  1.3 * a);
}

/// A pose a little off, as localisation gives it.
inline Pose shaken(Pose T, double position_m, double angle_rad, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0.0, 1.0);
    const Eigen::Vector3d turn(noise(random), noise(random), noise(random));
    for (int d = 0; d < 3; ++d) T.t[d] += position_m * noise(random);
    T.R = T.R *
          Eigen::AngleAxisd(angle_rad * turn.norm(), turn.normalized()).toRotationMatrix();
    return T;
}

/// `scans` scans of the scanner's room from a walk through it.
inline Map mapOf(const RoomScanner& scanner, int scans, const MapParams& params = {},
                 const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
    Map map(params);
    for (int k = 0; k < scans; ++k) {
        Scan scan = scanner.scan(walk(k), 100 + static_cast<std::uint64_t>(k));
        scan.T_map_sensor.t += offset;
        map.insert(scan);
    }
    return map;
}

}  // namespace hgmm::testing
