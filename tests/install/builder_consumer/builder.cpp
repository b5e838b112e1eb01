#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/slam/CMetricMapBuilderHGMM.h>

#include <iostream>

namespace {

/// A wall ahead and one to the left, as seen from x on a straight way.
mrpt::obs::CSensoryFrame frameFrom(float x_m, double time_s) {
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->pointcloud = mrpt::maps::CSimplePointsMap::Create();
    for (int i = 0; i < 60; ++i)
        for (int k = 0; k < 20; ++k) {
            const float along_m = 0.1F * float(i), up_m = 0.1F * float(k);
            observation->pointcloud->insertPoint(6.F - x_m, along_m - 3.F, up_m);
            observation->pointcloud->insertPoint(along_m - x_m, 3.F, up_m);
            observation->pointcloud->insertPoint(along_m - x_m, along_m - 3.F, 0.F);
        }
    observation->timestamp = mrpt::Clock::fromDouble(time_s);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    return frame;
}

}  // namespace

int main() {
    mrpt::slam::CMetricMapBuilderHGMM builder;
    for (int i = 0; i < 10; ++i) {
        mrpt::obs::CActionCollection none;
        mrpt::obs::CSensoryFrame frame = frameFrom(0.1F * float(i), 1000.0 + 0.1 * i);
        builder.processActionObservation(none, frame);
    }
    mrpt::poses::CPose3D end;
    builder.getCurrentPoseEstimation()->getMean(end);
    std::cout << "consumer-builder: " << builder.getCurrentlyBuiltMapSize()
              << " keyframe(s), end at " << end.x() << "\n";
    return builder.isLost() || end.x() < 0.8 || end.x() > 1.0 ? 1 : 0;
}
