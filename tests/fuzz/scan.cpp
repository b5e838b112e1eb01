// A scan of any floats: validate, the filter and what becomes of its samples.
#include <cmath>

#include "harness.h"
#include "oracle.h"
#include "random_input.h"

namespace hgmm::fuzz {

namespace {

std::vector<float> floatsFrom(Bytes& bytes, std::size_t n) {
    std::vector<float> floats;
    for (std::size_t i = 0; i < n; ++i) floats.push_back(bytes.raw<float>());
    return floats;
}

Scan rawScan(Bytes& bytes) {
    Scan scan;
    const std::size_t n = bytes.below(64);
    scan.x = floatsFrom(bytes, n);
    scan.y = floatsFrom(bytes, n);
    scan.z = floatsFrom(bytes, n - (bytes.below(32) == 31 && n > 0 ? 1 : 0));
    for (unsigned c = bytes.below(3); c > 0; --c)
        scan.channels.push_back({c == 1 ? "r" : "heat", floatsFrom(bytes, n)});
    for (unsigned k = bytes.below(8); k > 0; --k) {
        const auto f = floatsFrom(bytes, 4);
        scan.clearedRays.push_back({{f[0], f[1], f[2]}, f[3]});
        if (bytes.coin()) scan.clearedRays.back().direction.normalize();
    }
    return scan;
}

}  // namespace

void runOne(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const MapParams params = paramsFrom(bytes);
    Scan scan = rawScan(bytes);
    scan.T_map_sensor = poseFrom(bytes);
    Map map(params);
    try {
        const ScanSamples samples = samplesOf(scan, params);
        const FilterCounts& points = samples.points;
        require(points.used + points.notFinite + points.tooNear + points.cut == scan.size(),
                "the filter accounts for every point");
        require(samples.samples_sensor.size() <= scan.size(), "samples are no more");
        for (const ClearedRay& ray : samples.clearedRays_sensor)
            require(double(ray.length_m) <= params.filter.maxRange_m * (1 + 1e-6),
                    "cleared rays end at maxRange_m");
        map.insert(scan);
        map.insert(scan);
    } catch (const std::invalid_argument&) {
        return;
    }
    requireSoundAnswers(map, size);
    requireStableSaving(map);
}

}  // namespace hgmm::fuzz
