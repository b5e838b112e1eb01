#include "hgmm/global_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "registration/surface_alignment.h"
#include "tracking/place_candidates.h"

namespace hgmm {

namespace {

/// Samples that align a candidate.
constexpr std::size_t kAligningSamples = 1000;
/// Candidates may be off by this much [m], [rad].
constexpr SearchRadius kOff{0.7, 0.15};

}  // namespace

FreePositions freePositionsOf(const Map& map, std::size_t most) {
    constexpr double kFinest_m = 0.5, kOffset = 1 << 20;
    const Mixture<4>& free = map.freeMixture();
    for (double cell_m = kFinest_m;; cell_m *= M_SQRT2) {
        FreePositions found{{}, cell_m};
        std::unordered_set<std::uint64_t> taken;
        for (std::size_t i = 0; i < free.size() && found.positions_local.size() <= most;
             ++i) {
            const Eigen::Vector3d p(free.mean[0][i], free.mean[1][i], free.mean[2][i]);
            if (!(p.cwiseAbs().maxCoeff() / cell_m < kOffset)) continue;
            std::uint64_t cell = 0;
            for (int d = 0; d < 3; ++d)
                cell = (cell << 21) +
                       std::uint64_t(std::int64_t(std::floor(p[d] / cell_m) + kOffset));
            if (taken.insert(cell).second) found.positions_local.push_back(p);
        }
        if (found.positions_local.size() <= most) return found;
    }
}

void GlobalSearchParams::validate() const {
    requireInRange("maxPositions", maxPositions, 1, 1e6);
    requireInRange("headings", headings, 1, 360);
    requireInRange("aligned", aligned, 1, 1e4);
    requireInRange("minOverlap", minOverlap, 1e-6, 1.0);
    requireInRange("minLead", minLead, 0.0, 1.0);
}

std::optional<PoseEstimate> findInMap(const Map& map, const ScanSamples& scan,
                                      const GlobalSearchParams& params) {
    params.validate();
    if (map.empty() || scan.samples_sensor.empty()) return {};
    const AlignmentSamples more(scan.samples_sensor, scan.normalOfRays_sensor,
                                kAligningSamples);
    PlaceSearch search;
    search.headings = params.headings;
    search.mostKept = static_cast<std::size_t>(params.aligned);
    const std::vector<PlaceCandidate> candidates = likeliestPlaces(
        map, scan,
        freePositionsOf(map, static_cast<std::size_t>(params.maxPositions)).positions_local,
        search);

    const PatchTree<3> surfaces(map.mixture());
    std::vector<SurfaceAlignment> found;
    for (const PlaceCandidate& candidate : candidates) {
        AlignmentPrior prior;
        prior.T_target_sensor = candidate.T_local_sensor;
        prior.deviation = kOff;
        prior.covariance = covarianceOf(kOff);
        found.push_back(alignToSurfaces(surfaces, more, prior));
    }
    if (found.empty()) return {};
    const auto best = std::max_element(
        found.begin(), found.end(),
        [](const auto& a, const auto& b) { return a.overlap < b.overlap; });
    if (best->overlap < params.minOverlap) return {};
    for (const SurfaceAlignment& other : found)
        if (!areOnePlace(other.T_target_sensor, best->T_target_sensor) &&
            other.overlap > best->overlap - params.minLead)
            return {};
    PoseEstimate estimate;
    estimate.T_map_sensor = {best->T_target_sensor.R,
                             best->T_target_sensor.t + map.origin()};
    estimate.covariance = best->covariance;
    return estimate;
}

}  // namespace hgmm
