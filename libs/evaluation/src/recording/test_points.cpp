#include "hgmm/evaluation/test_points.h"

#include <algorithm>
#include <cmath>

namespace hgmm::evaluation {
namespace {

Eigen::Vector3d pointOf(const Scan& scan, std::size_t i) {
    return {scan.x[i], scan.y[i], scan.z[i]};
}

/// The indices of points that can be drawn, out of `chosen`.
std::vector<std::size_t> finiteOf(const Scan& scan, std::vector<std::size_t> chosen) {
    const auto bad = [&](std::size_t i) { return !pointOf(scan, i).allFinite(); };
    chosen.erase(std::remove_if(chosen.begin(), chosen.end(), bad), chosen.end());
    return chosen;
}

}  // namespace

/// `hits` are the latest of hits_map_, as indices into the scan.
template <class Band>
void TestPoints::drawFree(const Scan& scan, const std::vector<std::size_t>& hits,
                          std::size_t scanIndex, Draw use, const Band& band,
                          FreePoints& free) {
    std::mt19937_64 stream = randomStream(seed_, scanIndex, use);
    const std::size_t first = hits_map_.size() - hits.size();
    for (std::size_t k = 0; k < hits.size(); ++k) {
        // Drawn for rays that are too short as well, so that one ray never shifts others.
        const double share = nextUniform(stream);
        const Eigen::Vector3d hit_sensor = pointOf(scan, hits[k]);
        const double ray_m = hit_sensor.norm();
        const std::optional<double> range_m = rangeIn(band, ray_m, share);
        if (!range_m) continue;
        const Eigen::Vector3d free_sensor = *range_m / ray_m * hit_sensor;
        free.points_map.push_back(scan.T_map_sensor.R * free_sensor + scan.T_map_sensor.t);
        free.hits.push_back(first + k);
    }
}

void TestPoints::add(const Scan& scan, std::size_t scanIndex) {
    const auto draw = [&](std::size_t n, Draw use) {
        return finiteOf(scan, chooseIndices(scan.size(), n, seed_, scanIndex, use));
    };
    const std::vector<std::size_t> hits = draw(kQueriesPerScan, Draw::queries);
    appendPoints(scan, hits, hits_map_);
    drawFree(scan, hits, scanIndex, Draw::uniformFree, freeBand_, uniformFree_);
    drawFree(scan, hits, scanIndex, Draw::nearFree, nearBand_, nearFree_);
    appendPoints(scan, draw(kReferencePerScan, Draw::reference), reference_map_);
}

}  // namespace hgmm::evaluation
