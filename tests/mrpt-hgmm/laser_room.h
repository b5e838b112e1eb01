#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include "observations.h"

/// The 8 x 6 m room of observations::laser().
namespace laser_room {

/// The map, of scans all round from the middle.
inline mrpt::maps::CHGMMOccupancyMap map(
    const mrpt::poses::CPose3D& middle = mrpt::poses::CPose3D(0, 0, 0.2, 0, 0, 0)) {
    mrpt::maps::CHGMMOccupancyMap map;
    for (const double yaw : {0.0, M_PI})
        map.insertObservation(*observations::laser(),
                              middle + mrpt::poses::CPose3D(0, 0, 0, yaw, 0, 0));
    return map;
}

/// One scan of it, in the robot's frame.
inline mrpt::maps::CSimplePointsMap points() {
    mrpt::maps::CSimplePointsMap points;
    points.insertionOptions.minDistBetweenLaserPoints = 0.F;
    points.insertObservation(*observations::laser());
    return points;
}

}  // namespace laser_room
