#include "hgmm/global_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "hgmm/likelihood.h"
#include "registration/surface_alignment.h"

namespace hgmm {

namespace {

/// Samples that rate a candidate, and that align it.
constexpr std::size_t kRatingSamples = 80, kAligningSamples = 1000;
/// The rating's kernel is about as wide as candidates are apart [m].
constexpr double kKernelWidth_m = 0.5, kOutlierRatio = 0.3;
/// Candidates may be off by this much [m], [rad].
constexpr SearchRadius kOff{0.7, 0.15};
/// Poses nearer than this are one place [m], [rad].
constexpr double kSamePlace_m = 0.5, kSamePlace_rad = 0.2;

struct PlaceCandidate {
    Pose T_local_sensor;
    double score = 0.0;  ///< mean log-likelihood of the samples [nat]
};

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

double scoreOf(const SurfaceLikelihood& likelihood, const AlignmentSamples& samples,
               const Pose& T) {
    double sum = 0.0;
    for (const Eigen::Vector3d& m : samples.mean) {
        const Eigen::Vector3f p = (T.R * m + T.t).cast<float>();
        sum += likelihood(p.x(), p.y(), p.z());
    }
    return sum / double(samples.size());
}

/// Each position in its best heading, the likeliest first.
std::vector<PlaceCandidate> ratedCandidates(const SurfaceLikelihood& likelihood,
                                            const std::vector<Eigen::Vector3d>& positions,
                                            const AlignmentSamples& samples, int headings) {
    std::vector<PlaceCandidate> candidates(positions.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(positions.size()); ++k) {
        PlaceCandidate& best = candidates[static_cast<std::size_t>(k)];
        for (int h = 0; h < headings; ++h) {
            Pose T;
            T.R = Eigen::AngleAxisd(2.0 * M_PI * h / headings, Eigen::Vector3d::UnitZ())
                      .toRotationMatrix();
            T.t = positions[static_cast<std::size_t>(k)];
            const double score = scoreOf(likelihood, samples, T);
            if (h == 0 || score > best.score) best = {T, score};
        }
    }
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.score > b.score; });
    return candidates;
}

bool areOnePlace(const Pose& a, const Pose& b) {
    return (a.t - b.t).norm() < kSamePlace_m &&
           Eigen::AngleAxisd(Eigen::Matrix3d(a.R * b.R.transpose())).angle() <
               kSamePlace_rad;
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
    const AlignmentSamples few(scan.samples_sensor, scan.normalOfRays_sensor,
                               kRatingSamples);
    if (map.empty() || few.size() == 0) return {};
    const AlignmentSamples more(scan.samples_sensor, scan.normalOfRays_sensor,
                                kAligningSamples);
    const SurfaceLikelihood likelihood(map.mixture(), kKernelWidth_m, kOutlierRatio);
    std::vector<PlaceCandidate> candidates = ratedCandidates(
        likelihood,
        freePositions(map.freeMixture(), static_cast<std::size_t>(params.maxPositions)),
        few, params.headings);
    if (candidates.size() > static_cast<std::size_t>(params.aligned))
        candidates.resize(static_cast<std::size_t>(params.aligned));

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
