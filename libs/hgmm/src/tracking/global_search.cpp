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

/// Means of free space, at most so many: the first of each cell of a grid that is as fine
/// as it may be.
std::vector<Eigen::Vector3d> freePositions(const Mixture<4>& free, std::size_t most) {
    constexpr double kCell_m = 0.5, kOffset = 1 << 20;
    std::vector<Eigen::Vector3d> positions;
    for (double cell_m = kCell_m;; cell_m *= M_SQRT2) {
        positions.clear();
        std::unordered_set<std::uint64_t> taken;
        for (std::size_t i = 0; i < free.size() && positions.size() <= most; ++i) {
            const Eigen::Vector3d p(free.mean[0][i], free.mean[1][i], free.mean[2][i]);
            if (!(p.cwiseAbs().maxCoeff() / cell_m < kOffset)) continue;
            std::uint64_t cell = 0;
            for (int d = 0; d < 3; ++d)
                cell = (cell << 21) +
                       std::uint64_t(std::int64_t(std::floor(p[d] / cell_m) + kOffset));
            if (taken.insert(cell).second) positions.push_back(p);
        }
        if (positions.size() <= most) return positions;
    }
}

}  // namespace

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
        freePositions(map.freeMixture(), static_cast<std::size_t>(params.maxPositions)),
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
