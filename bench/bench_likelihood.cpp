// What a particle filter does most, on our map and on MRPT's own: the likelihood of a scan
// at many poses, and copies of a CMultiMetricMap.
//   build/bin/bench-likelihood
// items_per_second are points compared x poses. 2D maps are built from MRPT's
// localization_demo.simplemap.gz, 3D maps from scans of a simulated room.
#include <benchmark/benchmark.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/COctoMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "room_scanner.h"

namespace {

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::maps::CMetricMap;
using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::COctoMap;
using mrpt::maps::CSimplePointsMap;
using mrpt::poses::CPose3D;

/// Of each scan, in every map [count].
constexpr int kPoints2d = 60, kPoints3d = 200;

struct PosedScan {
    mrpt::obs::CObservation::Ptr observation;
    CPose3D pose;
    std::size_t points = 0;
};

const std::vector<PosedScan>& laserScans() {
    static const std::vector<PosedScan> scans = [] {
        mrpt::maps::CSimpleMap map;
        if (!map.loadFromFile("/usr/share/mrpt/datasets/localization_demo.simplemap.gz"))
            throw std::runtime_error("localization_demo.simplemap.gz: see mrpt-common");
        std::vector<PosedScan> all;
        for (const auto& keyframe : map)
            for (const auto& o : *keyframe.sf)
                if (const auto scan = hgmm::mrpt_bridge::observationToScan(*o))
                    all.push_back({o, keyframe.pose->getMeanVal(), scan->size()});
        return all;
    }();
    return scans;
}

const std::vector<PosedScan>& roomScans() {
    static const std::vector<PosedScan> scans = [] {
        hgmm::testing::RoomScanner room;
        room.azimuths = 900;
        std::vector<PosedScan> all;
        for (int i = 0; i < 10; ++i) {
            const hgmm::Pose pose = hgmm::testing::poseAt(0.1 * i, 0.05 * i, 1.2, 0.2 * i);
            const hgmm::Scan scan = room.scan(pose, 1000 + unsigned(i));
            auto cloud = CSimplePointsMap::Create();
            for (std::size_t k = 0; k < scan.size(); ++k)
                cloud->insertPoint(scan.x[k], scan.y[k], scan.z[k]);
            auto observation = mrpt::obs::CObservationPointCloud::Create();
            observation->pointcloud = cloud;
            all.push_back({observation, hgmm::mrpt_bridge::toCPose3D(pose), scan.size()});
        }
        return all;
    }();
    return scans;
}

unsigned decimationFor(const std::vector<PosedScan>& scans, int points) {
    return static_cast<unsigned>(scans.front().points / std::size_t(points));
}

void insertAll(CMetricMap& map, const std::vector<PosedScan>& scans) {
    for (const PosedScan& scan : scans) map.insertObservation(*scan.observation, scan.pose);
}

CMetricMap::Ptr hgmmOf(const std::vector<PosedScan>& scans, int points) {
    auto map = CHGMMOccupancyMap::Create();
    map->likelihoodOptions.maxPoints = points;
    insertAll(*map, scans);
    return map;
}

CMetricMap::Ptr hgmm2d() {
    return hgmmOf(laserScans(), kPoints2d);
}
CMetricMap::Ptr hgmm3d() {
    return hgmmOf(roomScans(), kPoints3d);
}

CMetricMap::Ptr grid2d() {
    auto map = COccupancyGridMap2D::Create(-20.F, 20.F, -20.F, 20.F, 0.05F);
    map->likelihoodOptions.likelihoodMethod = COccupancyGridMap2D::lmLikelihoodField_Thrun;
    map->likelihoodOptions.LF_decimation = decimationFor(laserScans(), kPoints2d);
    insertAll(*map, laserScans());
    return map;
}

CMetricMap::Ptr points2d() {
    auto map = CSimplePointsMap::Create();
    map->insertionOptions.minDistBetweenLaserPoints = 0.05F;
    map->likelihoodOptions.decimation = decimationFor(laserScans(), kPoints2d);
    insertAll(*map, laserScans());
    return map;
}

CMetricMap::Ptr points3d() {
    auto map = CSimplePointsMap::Create();
    map->likelihoodOptions.decimation = decimationFor(roomScans(), kPoints3d);
    // By hand, because it forgets the robot's pose when it inserts a point cloud.
    for (const PosedScan& scan : roomScans())
        map->insertAnotherMap(
            dynamic_cast<const mrpt::obs::CObservationPointCloud&>(*scan.observation)
                .pointcloud.get(),
            scan.pose);
    return map;
}

CMetricMap::Ptr octomap3d() {
    auto map = COctoMap::Create(0.1);
    map->likelihoodOptions.decimation = decimationFor(roomScans(), kPoints3d);
    insertAll(*map, roomScans());
    return map;
}

/// Poses up to 0.5 m and 15 deg off, as particles are that have begun to converge.
std::vector<CPose3D> particlesAround(const CPose3D& pose) {
    std::vector<CPose3D> particles;
    for (int i = 0; i < 100; ++i)
        particles.push_back(pose + CPose3D(0.005 * ((i * 37) % 100), -0.005 * (i % 50), 0,
                                           0.005 * ((i * 61) % 50), 0, 0));
    return particles;
}

using MakeMap = CMetricMap::Ptr (*)();
using Scans = const std::vector<PosedScan>& (*)();

void likelihood(benchmark::State& state, MakeMap makeMap, Scans scans, int points) {
    const CMetricMap::Ptr map = makeMap();
    std::vector<std::pair<const PosedScan*, std::vector<CPose3D>>> work;
    for (std::size_t i = 0; i < scans().size(); i += 1 + scans().size() / 10)
        work.emplace_back(&scans()[i], particlesAround(scans()[i].pose));
    std::int64_t poses = 0;
    for (auto _ : state)
        for (const auto& [scan, particles] : work)
            for (const CPose3D& particle : particles) {
                benchmark::DoNotOptimize(
                    map->computeObservationLikelihood(*scan->observation, particle));
                ++poses;
            }
    state.SetItemsProcessed(poses * points);
}
BENCHMARK_CAPTURE(likelihood, hgmm_2d, hgmm2d, laserScans, kPoints2d);
BENCHMARK_CAPTURE(likelihood, grid_2d, grid2d, laserScans, kPoints2d);
BENCHMARK_CAPTURE(likelihood, points_2d, points2d, laserScans, kPoints2d);
BENCHMARK_CAPTURE(likelihood, hgmm_3d, hgmm3d, roomScans, kPoints3d);
BENCHMARK_CAPTURE(likelihood, points_3d, points3d, roomScans, kPoints3d);
BENCHMARK_CAPTURE(likelihood, octomap_3d, octomap3d, roomScans, kPoints3d);

/// As a particle filter copies particles: through serialisation.
void copyMultiMap(benchmark::State& state, MakeMap makeMap) {
    mrpt::maps::CMultiMetricMap multi;
    multi.maps.push_back(makeMap());
    for (auto _ : state) {
        mrpt::maps::CMultiMetricMap copy(multi);
        benchmark::DoNotOptimize(copy);
    }
}
BENCHMARK_CAPTURE(copyMultiMap, hgmm_2d, hgmm2d);
BENCHMARK_CAPTURE(copyMultiMap, grid_2d, grid2d);
BENCHMARK_CAPTURE(copyMultiMap, points_2d, points2d);
BENCHMARK_CAPTURE(copyMultiMap, hgmm_3d, hgmm3d);
BENCHMARK_CAPTURE(copyMultiMap, points_3d, points3d);
BENCHMARK_CAPTURE(copyMultiMap, octomap_3d, octomap3d);

}  // namespace
