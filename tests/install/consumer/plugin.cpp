#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <iostream>

int main() {
    mrpt::obs::CObservationPointCloud observation;
    observation.pointcloud = mrpt::maps::CSimplePointsMap::Create();
    for (int i = 0; i < 100; ++i)
        observation.pointcloud->insertPoint(3.F, 0.01F * float(i % 10),
                                            0.01F * float(i / 10));
    mrpt::maps::CHGMMOccupancyMap map;
    map.insertObservation(observation);
    std::cout << "consumer-plugin: " << map.model().mixture().size() << " component(s)\n";
}
