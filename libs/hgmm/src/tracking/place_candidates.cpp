#include "tracking/place_candidates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hgmm/likelihood.h"

namespace hgmm {

namespace {

/// Share of measurements that the map does not explain.
constexpr double kOutlierRatio = 0.3;
/// Poses nearer than this are one place [m], [rad].
constexpr double kSamePlace_m = 0.5, kSamePlace_rad = 0.2;

double scoreOf(const SurfaceLikelihood& likelihood, const AlignmentSamples& samples,
               const Pose& T) {
    double sum = 0.0;
    for (const Eigen::Vector3d& m : samples.mean) {
        const Eigen::Vector3f p = (T.R * m + T.t).cast<float>();
        sum += likelihood(p.x(), p.y(), p.z());
    }
    return sum / double(samples.size());
}

PlaceCandidate bestHeading(const SurfaceLikelihood& likelihood,
                           const AlignmentSamples& samples, const Eigen::Vector3d& position,
                           const PlaceSearch& search) {
    PlaceCandidate best;
    for (int h = 0; h < search.headings; ++h) {
        Pose T;
        T.R = Eigen::AngleAxisd(2.0 * M_PI * h / search.headings, Eigen::Vector3d::UnitZ())
                  .toRotationMatrix() *
              search.R_local;
        T.t = position;
        const double score = scoreOf(likelihood, samples, T);
        if (h == 0 || score > best.score) best = {T, score};
    }
    return best;
}

}  // namespace

std::vector<PlaceCandidate> likeliestPlaces(const Map& map, const ScanSamples& scan,
                                            const std::vector<Eigen::Vector3d>& positions,
                                            const PlaceSearch& search) {
    const AlignmentSamples few(scan.samples_sensor, scan.normalOfRays_sensor,
                               search.samples);
    if (few.size() == 0) return {};
    const SurfaceLikelihood likelihood(map.mixture(), search.kernelWidth_m, kOutlierRatio);
    std::vector<PlaceCandidate> candidates(positions.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(positions.size()); ++k) {
        const auto i = static_cast<std::size_t>(k);
        candidates[i] = bestHeading(likelihood, few, positions[i], search);
    }
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.score > b.score; });
    if (candidates.size() > search.mostKept) candidates.resize(search.mostKept);
    return candidates;
}

bool areOnePlace(const Pose& a, const Pose& b) {
    return (a.t - b.t).norm() < kSamePlace_m &&
           Eigen::AngleAxisd(Eigen::Matrix3d(a.R * b.R.transpose())).angle() <
               kSamePlace_rad;
}

}  // namespace hgmm
