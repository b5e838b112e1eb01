#include "studies/thesis_free_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hgmm/em.h"
#include "hgmm/joint_moments.h"
#include "hgmm/regression.h"

namespace replay {
namespace {

using hgmm::Gaussian;
using hgmm::Mixture;
using hgmm::evaluation::Answer;

/// Free points lie so far before a surface, and eq. (4.15) integrates over twice as much to
/// either side [m].
constexpr double kFreePoint_m = 1e-3;
constexpr double kInterval_m = 2e-3;

/// A hit belongs to surfaces within so many sigma, as in the map's novelty test.
constexpr double kHitSigmas = 3.0;

double normalMass(double low, double high, double mean, double variance) {
    const double perSigma = std::sqrt(0.5 / variance);
    return 0.5 * (std::erf((high - mean) * perSigma) - std::erf((low - mean) * perSigma));
}

Gaussian<3> placeOf(const Gaussian<4>& g) {
    Gaussian<3> place;
    place.support = g.support;
    place.mean = g.mean.head<3>();
    place.covariance = g.covariance.topLeftCorner<3, 3>();
    return place;
}

/// Adds the rays of one scan to the free space of the surfaces that they ended in.
void addRays(const Mixture<3>& samples, const Eigen::Vector3d& sensorOrigin,
             const Mixture<3>& surfaces, std::vector<Gaussian<4>>& free) {
    const hgmm::Neighbourhoods near =
        hgmm::neighbourhoodsOf(samples.mean, surfaces, kHitSigmas);
    std::vector<Gaussian<3>> hits(surfaces.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Gaussian<3> sample = samples[i];
        const std::uint32_t count = near.begin[i + 1] - near.begin[i];
        sample.support /= count;
        for (std::uint32_t k = near.begin[i]; k < near.begin[i + 1]; ++k) {
            Gaussian<3>& hit = hits[near.component[k]];
            hit = hit.support > 0 ? hgmm::mergeMoments(hit, sample) : sample;
        }
    }
    for (std::size_t j = 0; j < hits.size(); ++j) {
        if (!(hits[j].support > 0)) continue;
        const double range = (sensorOrigin - hits[j].mean).norm();
        const Gaussian<4> rays = hgmm::raySegmentMoments(hits[j], sensorOrigin, 0.0, range);
        free[j] = free[j].support > 0 ? hgmm::mergeMoments(free[j], rays) : rays;
    }
}

}  // namespace

/// Components over (X, W), surfaces and free space, ready to be asked.
struct ThesisFreeSpace::Model {
    Mixture<3> places;  ///< their marginals over X, to find them by
    std::vector<hgmm::RegressedGaussian<4>> joints;

    void add(const Gaussian<4>& joint) {
        if (!(joint.support > 0)) return;
        places.pushBack(placeOf(joint));
        joints.emplace_back(joint, joint.support);
    }

    Answer at(const Eigen::Vector3d& x, const std::uint32_t* first,
              const std::uint32_t* last, const hgmm::OccupancyParams& params) const {
        double occupied = 0, free = 0, behind = 0, known = 0;
        for (; first != last; ++first) {
            const hgmm::RegressedGaussian<4>& joint = joints[*first];
            const double density = std::exp(joint.logWeightedDensity(x.data()));
            const double w = joint.mean(x.data()), variance = joint.variance();
            constexpr double infinity = std::numeric_limits<double>::infinity();
            // thesis eq. (4.15), (4.16)
            occupied += density * normalMass(-kInterval_m, kInterval_m, w, variance);
            free += density * normalMass(kInterval_m, infinity, w, variance);
            behind += density * normalMass(-infinity, -kInterval_m, w, variance);
            const hgmm::WhitenedGaussian<3> place(places[*first]);
            known += std::exp(-0.5 * place.squaredMahalanobis(x.data()));
        }
        Answer answer;
        const double total = occupied + free + behind;
        if (!(total > 0)) return answer;
        const double unknownDensity =
            std::exp(-0.5 * params.knownSigmas * params.knownSigmas);
        const double seen = known / (known + unknownDensity) / total;
        const double unknown = 1 - (occupied + free) * seen;
        answer.probability = occupied * seen + 0.5 * unknown;
        answer.unknown = unknown > 0.5;
        return answer;
    }
};

ThesisFreeSpace::ThesisFreeSpace(const hgmm::MapParams& params) : map_(params) {}
ThesisFreeSpace::~ThesisFreeSpace() = default;

std::vector<std::pair<std::string, double>> ThesisFreeSpace::options() const {
    return {{"freeShare", map_.params().occupancy.band.freeShare},
            {"freePoint_m", kFreePoint_m},
            {"interval_m", kInterval_m}};
}

void ThesisFreeSpace::insert(const hgmm::Scan& scan) {
    hgmm::ScanSamples samples = hgmm::samplesOf(scan, map_.params());
    map_.insert(samples, scan.T_map_sensor);
    const hgmm::Pose T_local_sensor{scan.T_map_sensor.R,
                                    scan.T_map_sensor.t - map_.origin()};
    scans_.push_back(
        {hgmm::transformed(samples.samples_sensor, T_local_sensor), T_local_sensor.t});
    model_.reset();
}

const ThesisFreeSpace::Model& ThesisFreeSpace::model() const {
    if (model_) return *model_;
    const Mixture<3>& surfaces = map_.mixture();
    std::vector<Gaussian<4>> free(surfaces.size());
    auto made = std::make_unique<Model>();
    if (!surfaces.empty())
        for (const InsertedScan& scan : scans_)
            addRays(scan.samples_local, scan.sensorOrigin_local, surfaces, free);
    for (std::size_t j = 0; j < surfaces.size(); ++j) {
        made->add(hgmm::augmented(surfaces[j], map_.viewDirections()[j], kFreePoint_m,
                                  map_.params().occupancy.band.freeShare));
        made->add(free[j]);
    }
    model_ = std::move(made);
    return *model_;
}

void ThesisFreeSpace::query(const Eigen::Vector3d* points_map, std::size_t n,
                            Answer* answers) const {
    const Model& m = model();
    std::fill(answers, answers + n, Answer());
    if (m.joints.empty()) return;
    std::array<std::vector<float>, 3> points_local;
    for (std::size_t i = 0; i < n; ++i)
        for (int d = 0; d < 3; ++d)
            points_local[d].push_back(
                static_cast<float>(points_map[i][d] - map_.origin()[d]));
    const hgmm::Neighbourhoods near =
        hgmm::neighbourhoodsOf(points_local, m.places, hgmm::kReachSigmas);
    for (std::size_t i = 0; i < n; ++i)
        answers[i] =
            m.at(points_map[i] - map_.origin(), near.component.data() + near.begin[i],
                 near.component.data() + near.begin[i + 1], map_.params().occupancy);
}

std::size_t ThesisFreeSpace::liveBytes() const {
    std::size_t bytes = map_.liveBytes();
    for (const InsertedScan& scan : scans_)
        bytes += scan.samples_local.size() * sizeof(float) * (1 + 3 + Mixture<3>::packed);
    return bytes;
}

std::optional<std::size_t> ThesisFreeSpace::serializedBytes() const {
    constexpr std::size_t floats = 1 + 4 + Mixture<4>::packed;
    return model().joints.size() * floats * sizeof(float);
}

}  // namespace replay
