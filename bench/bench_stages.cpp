// The stages of hgmm::Map::insert and the queries, on scans of a simulated room.
//   build/bin/bench-hgmm
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "fusion/update.h"
#include "hgmm/hierarchy.h"
#include "hgmm/likelihood.h"
#include "hgmm/map.h"
#include "room_scanner.h"

namespace {

using hgmm::testing::poseAt;
using hgmm::testing::RoomScanner;

hgmm::Scan scanAt(int i) {
    RoomScanner room;
    room.azimuths = 1800;  // 57 600 points, as a 32-ring lidar has
    return room.scan(poseAt(0.1 * (i % 10), 0.05 * (i % 10), 1.2, 0.2 * i), 1000 + i);
}

/// A map of `rooms` rooms side by side, to show that cost does not follow the map's size.
hgmm::Map corridorOfRooms(int rooms) {
    hgmm::Map map;
    for (int k = 0; k < rooms; ++k) {
        hgmm::Scan scan = scanAt(0);
        scan.T_map_sensor.t.x() += 10.0 * k;
        map.insert(scan);
    }
    return map;
}

void reportPerPoint(benchmark::State& state, std::size_t points) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points));
}

void filter(benchmark::State& state) {
    const hgmm::Scan scan = scanAt(0);
    for (auto _ : state) benchmark::DoNotOptimize(hgmm::filterScan(scan, {}));
    reportPerPoint(state, scan.size());
}
BENCHMARK(filter);

void noveltySplit(benchmark::State& state) {
    const hgmm::Map map = corridorOfRooms(static_cast<int>(state.range(0)));
    hgmm::ComponentIndex index;
    index.rebuild(map.mixture());
    const hgmm::Scan scan = scanAt(1);
    const auto samples =
        transformed(hgmm::filterScan(scan, {}),
                    {scan.T_map_sensor.R, scan.T_map_sensor.t - map.origin()});
    for (auto _ : state) benchmark::DoNotOptimize(hgmm::splitByNovelty(samples, index, {}));
    reportPerPoint(state, samples.size());
}
BENCHMARK(noveltySplit)->ArgName("rooms")->Arg(1)->Arg(100);

void sparseEm(benchmark::State& state) {
    const auto samples = hgmm::filterScan(scanAt(0), {});
    const auto initial = hgmm::initialiseFromCells(samples, Eigen::Vector3d::Zero(), {});
    for (auto _ : state)
        benchmark::DoNotOptimize(
            hgmm::fitSparse(samples, initial.mixture, initial.neighbourhoods, {}));
    reportPerPoint(state, samples.size());
}
BENCHMARK(sparseEm);

void hierarchy(benchmark::State& state) {
    const auto samples = hgmm::filterScan(scanAt(0), {});
    const auto initial = hgmm::initialiseFromCells(samples, Eigen::Vector3d::Zero(), {});
    for (auto _ : state)
        benchmark::DoNotOptimize(
            hgmm::generateHierarchy(initial.mixture, hgmm::HierarchyParams()));
    reportPerPoint(state, initial.mixture.size());
}
BENCHMARK(hierarchy);

/// A scan into a map that already knows the place, as nearly all scans of a log are.
void insertKnownScan(benchmark::State& state) {
    hgmm::Map map = corridorOfRooms(static_cast<int>(state.range(0)));
    int i = 0;
    std::vector<hgmm::Scan> scans;
    for (; i < 10; ++i) scans.push_back(scanAt(i));
    for (const hgmm::Scan& scan : scans) map.insert(scan);
    for (auto _ : state) benchmark::DoNotOptimize(map.insert(scans[std::size_t(++i % 10)]));
    reportPerPoint(state, scans[0].size());
}
BENCHMARK(insertKnownScan)->ArgName("rooms")->Arg(1)->Arg(100);

void logDensity(benchmark::State& state) {
    const hgmm::Map map = corridorOfRooms(static_cast<int>(state.range(0)));
    const hgmm::Scan scan = scanAt(1);
    for (auto _ : state)
        for (std::size_t k = 0; k < scan.size(); k += 10)
            benchmark::DoNotOptimize(map.logDensity(
                scan.T_map_sensor.t +
                scan.T_map_sensor.R * Eigen::Vector3d(scan.x[k], scan.y[k], scan.z[k])));
    reportPerPoint(state, scan.size() / 10);
}
BENCHMARK(logDensity)->ArgName("rooms")->Arg(1)->Arg(100);

/// Points evenly in the free space of the room, in one batch or one by one.
void occupancy(benchmark::State& state) {
    const hgmm::Map map = corridorOfRooms(1);
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Eigen::Vector3d> points(10000);
    for (Eigen::Vector3d& p : points) {
        const double x = unit(engine), y = unit(engine), z = unit(engine);
        p = {8.0 * x - 4.0, 6.0 * y - 3.0, 2.5 * z};
    }
    std::vector<hgmm::Occupancy> answers(points.size());
    map.occupancy(points[0]);
    for (auto _ : state) {
        if (state.range(0) == 1)
            map.occupancy(points.data(), points.size(), answers.data());
        else
            for (std::size_t i = 0; i < points.size(); ++i)
                answers[i] = map.occupancy(points[i]);
        benchmark::DoNotOptimize(answers.data());
    }
    reportPerPoint(state, points.size());
}
BENCHMARK(occupancy)->ArgName("batch")->Arg(0)->Arg(1);

/// The first answer of a copy, which prepares its index, and of a snapshot, which has it.
void firstAnswer(benchmark::State& state) {
    hgmm::Map map = corridorOfRooms(static_cast<int>(state.range(0)));
    const Eigen::Vector3d point = map.origin() + Eigen::Vector3d(1, 1, 0);
    map.occupancy(point);
    for (auto _ : state) {
        if (state.range(1) == 0)
            benchmark::DoNotOptimize(hgmm::Map(map).occupancy(point));
        else
            benchmark::DoNotOptimize(map.snapshot()->occupancy(point));
    }
    state.counters["KB"] = static_cast<double>(map.liveBytes()) / 1000;
}
BENCHMARK(firstAnswer)->ArgNames({"rooms", "snapshot"})->ArgsProduct({{1, 100}, {0, 1}});

void surfaceLikelihood(benchmark::State& state) {
    const hgmm::Map map = corridorOfRooms(1);
    const hgmm::SurfaceLikelihood likelihood(map.mixture(), 0.1, 0.05);
    const hgmm::Scan scan = scanAt(1);
    for (auto _ : state)
        for (std::size_t k = 0; k < scan.size(); k += 10)
            benchmark::DoNotOptimize(likelihood(scan.x[k], scan.y[k], scan.z[k]));
    reportPerPoint(state, scan.size() / 10);
}
BENCHMARK(surfaceLikelihood);

void saveAndLoad(benchmark::State& state) {
    const hgmm::Map map = corridorOfRooms(10);
    for (auto _ : state) {
        const auto buffer = map.save();
        benchmark::DoNotOptimize(hgmm::Map::load(buffer.data(), buffer.size()));
    }
    state.counters["components"] = static_cast<double>(map.mixture().size());
}
BENCHMARK(saveAndLoad);

}  // namespace
