// Two rooms with a doorway between them: makes the map of scans there, and says how near
// paths come to the walls that the scans were simulated from.
//   two-rooms save FILE.hgmm
//   two-rooms clearance PATHS.csv

#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "room_scanner.h"

namespace {

using hgmm::testing::Box;
using hgmm::testing::RoomScanner;

/// 8 m x 6 m x 2.5 m, a wall across at x = 0, open from y = 0.6 m to 1.6 m.
RoomScanner twoRooms() {
    RoomScanner scanner;
    scanner.furniture = {{Eigen::Vector3d(-0.1, -3.0, 0.0), Eigen::Vector3d(0.1, 0.6, 2.5)},
                         {Eigen::Vector3d(-0.1, 1.6, 0.0), Eigen::Vector3d(0.1, 3.0, 2.5)},
                         {Eigen::Vector3d(1.5, -0.5, 0.0), Eigen::Vector3d(2.1, 0.1, 2.5)}};
    scanner.elevations = 64;
    scanner.elevationSpan_rad = 2.4;
    return scanner;
}

void save(const std::string& file) {
    mrpt::maps::CHGMMOccupancyMap map;
    std::uint64_t seed = 1;
    for (const double x : {-3.0, -2.0, -1.0, 0.0, 1.0, 2.5, 3.0})
        for (const double y : {-2.0, 1.1}) {
            if (x == 0.0 && y < 0.6) continue;  // in the wall
            map.model().insert(
                twoRooms().scan(hgmm::testing::poseAt(x, y, 1.2, x), seed++));
        }
    map.saveToFile(file);
}

double distanceToWalls(const RoomScanner& scanner, const Eigen::Vector3d& p) {
    double least =
        std::min((p - scanner.room.min()).minCoeff(), (scanner.room.max() - p).minCoeff());
    for (const Box& box : scanner.furniture)
        least = std::min(least, box.exteriorDistance(p));
    return least;
}

/// Least distance of all segments, at places 1 mm apart [m].
double clearance(const std::string& file) {
    const RoomScanner scanner = twoRooms();
    std::ifstream in(file);
    std::string header;
    std::getline(in, header);
    double least = std::numeric_limits<double>::infinity();
    int plan = -1, segments = 0;
    Eigen::Vector3d before;
    for (std::string line; std::getline(in, line);) {
        int index = 0;
        Eigen::Vector3d p;
        if (std::sscanf(line.c_str(), "%d,%lf,%lf,%lf", &index, &p.x(), &p.y(), &p.z()) !=
            4)
            return -1.0;
        if (index == plan) {
            const double steps = std::ceil((p - before).norm() / 1e-3) + 1;
            for (double i = 0; i <= steps; ++i)
                least = std::min(
                    least, distanceToWalls(scanner, before + i / steps * (p - before)));
            ++segments;
        }
        plan = index;
        before = p;
    }
    return segments > 0 ? least : -1.0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    if (std::strcmp(argv[1], "save") == 0)
        save(argv[2]);
    else
        std::printf("clearance %.4f\n", clearance(argv[2]));
}
