// Modalities (thesis chapter 5): what they add to an insertion, and the questions to them.
//   build/bin/bench-hgmm --benchmark_filter=modal
#include <benchmark/benchmark.h>

#include <cmath>

#include "hgmm/map.h"
#include "room_scanner.h"

namespace {

using hgmm::testing::poseAt;
using hgmm::testing::RoomScanner;

/// A dense scan of the room, painted with stripes and soft shades.
hgmm::Scan paintedScan(int i) {
    RoomScanner room;
    room.azimuths = 1800;
    hgmm::Scan scan =
        room.scan(poseAt(0.1 * (i % 10), 0.05 * (i % 10), 1.2, 0.2 * i), 1000 + i);
    for (const char* name : {"r", "g", "b"}) scan.channels.push_back({name, {}});
    for (std::size_t k = 0; k < scan.size(); ++k) {
        const Eigen::Vector3d p =
            scan.T_map_sensor.R * Eigen::Vector3d(scan.x[k], scan.y[k], scan.z[k]) +
            scan.T_map_sensor.t;
        const double stripe = std::sin(9 * p.x() + 7 * p.y()) > 0 ? 0.8 : 0.2;
        const double shade = 0.5 + 0.3 * std::sin(2 * p.z() + p.x());
        scan.channels[0].values.push_back(static_cast<float>(stripe));
        scan.channels[1].values.push_back(static_cast<float>(0.5 * (stripe + shade)));
        scan.channels[2].values.push_back(static_cast<float>(shade));
    }
    return scan;
}

hgmm::Map paintedMap(bool withColours, int scans) {
    hgmm::MapParams params;
    if (withColours) params.modalities = {"r", "g", "b"};
    hgmm::Map map(params);
    for (int i = 0; i < scans; ++i) map.insert(paintedScan(i));
    return map;
}

/// A scan into a map that knows the place, without and with its three colours.
void insertWithModalities(benchmark::State& state) {
    hgmm::Map map = paintedMap(state.range(0) != 0, 10);
    std::vector<hgmm::Scan> scans;
    for (int i = 0; i < 10; ++i) scans.push_back(paintedScan(i));
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(map.insert(scans[++i % 10]));
    state.SetItemsProcessed(state.iterations() * std::int64_t(scans[0].size()));
}
BENCHMARK(insertWithModalities)->ArgName("rgb")->Arg(0)->Arg(1);

void modalityQuery(benchmark::State& state) {
    const hgmm::Map map = paintedMap(true, 5);
    const hgmm::Scan scan = paintedScan(2);
    std::size_t k = 0;
    for (auto _ : state) {
        k = (k + 97) % scan.size();
        benchmark::DoNotOptimize(map.modality(
            "r",
            scan.T_map_sensor.t +
                scan.T_map_sensor.R * Eigen::Vector3d(scan.x[k], scan.y[k], scan.z[k])));
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(modalityQuery);

/// Blue from red and green, without and with a known place.
void crossModalQuery(benchmark::State& state) {
    const hgmm::Map map = paintedMap(true, 5);
    const hgmm::Scan scan = paintedScan(2);
    std::size_t k = 0;
    for (auto _ : state) {
        k = (k + 97) % scan.size();
        const Eigen::Vector3d p =
            scan.T_map_sensor.t +
            scan.T_map_sensor.R * Eigen::Vector3d(scan.x[k], scan.y[k], scan.z[k]);
        const std::vector<hgmm::ModalityValue> priors = {{"r", scan.channels[0].values[k]},
                                                         {"g", scan.channels[1].values[k]}};
        benchmark::DoNotOptimize(state.range(0) != 0 ? map.infer("b", priors, p)
                                                     : map.infer("b", priors));
    }
    state.SetItemsProcessed(state.iterations());
}
BENCHMARK(crossModalQuery)->ArgName("place")->Arg(0)->Arg(1);

}  // namespace
