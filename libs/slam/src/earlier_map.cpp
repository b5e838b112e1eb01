#include "hgmm/slam/earlier_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "hgmm/global_search.h"
#include "vertical.h"

namespace hgmm::slam {
namespace {

constexpr double kKernel_m = 0.5;       // of the likelihood, at least
constexpr double kOutlierRatio = 0.3;   // share that the map does not explain
constexpr std::size_t kRatedMost = 80;  // components that rate a place
/// Poses nearer than this are one place.
constexpr double kSamePlace_m = 0.5, kSamePlace_rad = 0.2;
constexpr double kMargin_m = 0.5;  // about what a submap shows

std::shared_ptr<const Map> notEmpty(std::shared_ptr<const Map> map) {
    if (!map || map->empty()) throw std::invalid_argument("earlier map: is empty");
    return map;
}

bool areOnePlace(const Pose& a, const Pose& b, double within_m) {
    return (a.t - b.t).norm() < within_m &&
           rotationVectorOf(a.R * b.R.transpose()).norm() < kSamePlace_rad;
}

/// Few of the surfaces, evenly over all.
std::vector<Eigen::Vector3d> ratedPoints(const Mixture<3>& surfaces) {
    const std::size_t count = std::min(surfaces.size(), kRatedMost);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t k = 0; k < count; ++k)
        points.emplace_back(surfaces[k * surfaces.size() / count].mean);
    return points;
}

struct RatedPlace {
    Pose T_map_submap;
    Eigen::Vector3d sensor_map = Eigen::Vector3d::Zero();
    double heading_rad = 0.0;
    double score = 0.0;  // sum of log-likelihoods [nat]

    bool operator<(const RatedPlace& other) const { return score < other.score; }
};

/// What a place is rated by.
struct Rating {
    const SurfaceLikelihood& likelihood;
    std::vector<Eigen::Vector3d> points_submap;
    Eigen::Vector3d sensor_submap;
    Eigen::Matrix3d R_map_level, R_level_submap;  // level: z is up

    RatedPlace at(const Eigen::Vector3d& sensor_map, double heading_rad) const {
        RatedPlace place;
        place.sensor_map = sensor_map;
        place.heading_rad = heading_rad;
        place.T_map_submap.R =
            R_map_level * rotationOf({0, 0, heading_rad}) * R_level_submap;
        place.T_map_submap.t = sensor_map - place.T_map_submap.R * sensor_submap;
        for (const Eigen::Vector3d& point : points_submap) {
            const Eigen::Vector3f p =
                (place.T_map_submap.R * point + place.T_map_submap.t).cast<float>();
            place.score += likelihood(p.x(), p.y(), p.z());
        }
        return place;
    }

    RatedPlace bestHeading(const Eigen::Vector3d& sensor_map, int headings) const {
        RatedPlace best = at(sensor_map, 0.0);
        for (int h = 1; h < headings; ++h)
            best = std::max(best, at(sensor_map, 2.0 * M_PI * h / headings));
        return best;
    }

    /// The best about a place, a step to each side.
    RatedPlace refined(const RatedPlace& place, double step_m, double step_rad) const {
        RatedPlace best = place;
        for (int k = 0; k < 81; ++k) {
            const Eigen::Vector3d shift(k % 3 - 1, k / 3 % 3 - 1, k / 9 % 3 - 1);
            best = std::max(best, at(place.sensor_map + step_m * shift,
                                     place.heading_rad + step_rad * (k / 27 - 1)));
        }
        return best;
    }
};

/// The box that a submap's surfaces fill where it lies, and how uncertain that is.
Eigen::AlignedBox3d boxOf(const Mixture<3>& surfaces, const UncertainPose& T_map_submap) {
    const Pose& T = T_map_submap.T_a_b;
    Eigen::AlignedBox3d box(T.t);
    double farthest_m = 0.0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Eigen::Vector3d p = surfaces[i].mean;
        box.extend(T.R * p + T.t);
        farthest_m = std::max(farthest_m, p.norm());
    }
    const Matrix6d& covariance = T_map_submap.covariance;
    const double shift_m2 = covariance.bottomRightCorner<3, 3>().diagonal().maxCoeff();
    const double turn_rad2 = covariance.topLeftCorner<3, 3>().diagonal().maxCoeff();
    const double off_m = std::sqrt(shift_m2 + turn_rad2 * farthest_m * farthest_m);
    const double margin_m = kMargin_m + std::min(2.0 * off_m, 1e3);
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(margin_m);
    return {box.min() - margin, box.max() + margin};
}

UncertainPose almostSure(const Pose& pose) {
    return {pose, Matrix6d::Identity() * 1e-6};
}

}  // namespace

void EarlierMapParams::validate() const {
    const auto require = [](bool holds, const char* what) {
        if (!holds) throw std::invalid_argument(what);
    };
    require(maxPositions >= 1 && maxPositions <= 1000000,
            "maxPositions: must be in [1, 1e6]");
    require(headings >= 1 && headings <= 360, "headings: must be in [1, 360]");
    require(aligned >= 1 && aligned <= 10000, "aligned: must be in [1, 1e4]");
    require(minOverlap > 0 && minOverlap <= 1, "minOverlap: must be in (0, 1]");
    require(minFound >= 2, "minFound: must be at least 2");
    require(maxSearched >= 1, "maxSearched: must be at least 1");
}

EarlierMap::EarlierMap(std::shared_ptr<const Map> map, const EarlierMapParams& params)
    : params_((params.validate(), params)),
      map_(notEmpty(std::move(map))),
      likelihood_(surfacesInMapFrame(*map_), kKernel_m, kOutlierRatio) {
    const FreePositions free =
        freePositionsOf(*map_, static_cast<std::size_t>(params_.maxPositions));
    vertical_map_ = verticalOf(surfacesInMapFrame(*map_));
    for (const Eigen::Vector3d& position_local : free.positions_local)
        positions_map_.push_back(position_local + map_->origin());
    spacing_m_ = free.spacing_m;
    if (0.7 * spacing_m_ > kKernel_m)
        likelihood_ =
            SurfaceLikelihood(surfacesInMapFrame(*map_), 0.7 * spacing_m_, kOutlierRatio);
}

double EarlierMap::headingStep_rad() const {
    return 2.0 * M_PI / params_.headings;
}

std::vector<Pose> EarlierMap::likeliestPlaces(const FinishedSubmap& submap) const {
    const Rating rating{
        likelihood_, ratedPoints(submap.shape.surfaces_submap), submap.submap.sensor_submap,
        rotationFromZ(vertical_map_),
        rotationFromZ(verticalOf(submap.shape.surfaces_submap)).transpose()};
    std::vector<RatedPlace> rated(positions_map_.size());
#pragma omp parallel for schedule(static)
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(rated.size()); ++k) {
        const auto i = static_cast<std::size_t>(k);
        rated[i] = rating.bestHeading(positions_map_[i], params_.headings);
    }
    std::stable_sort(rated.begin(), rated.end(),
                     [](const RatedPlace& a, const RatedPlace& b) { return b < a; });
    std::vector<Pose> places;
    std::vector<Pose> refined;
    for (const RatedPlace& r : rated) {
        const bool known = std::any_of(places.begin(), places.end(), [&](const Pose& p) {
            return areOnePlace(p, r.T_map_submap, 1.5 * spacing_m_);
        });
        if (known) continue;
        places.push_back(r.T_map_submap);
        refined.push_back(
            rating.refined(r, spacing_m_ / 3.0, headingStep_rad() / 3.0).T_map_submap);
        if (static_cast<int>(places.size()) == params_.aligned) break;
    }
    return refined;
}

std::vector<UncertainPose> EarlierMap::placesOf(const FinishedSubmap& submap,
                                                const ClosureParams& closure) const {
    if (submap.shape.surfaces_submap.empty()) return {};
    const std::vector<Pose> places = likeliestPlaces(submap);
    ClosureParams strict = closure;
    strict.minOverlap = std::max(closure.minOverlap, params_.minOverlap);
    // What is left of the steps between the places.
    strict.registration.coarseWidth_m =
        std::max(strict.registration.fineWidth_m, 0.3 * spacing_m_);
    strict.registration.coarseAngle_rad =
        std::max(strict.registration.fineAngle_rad, 0.5 * headingStep_rad());
    std::vector<std::optional<UncertainPose>> verified(places.size());
#pragma omp parallel for schedule(dynamic)
    for (std::int64_t k = 0; k < static_cast<std::int64_t>(places.size()); ++k) {
        const auto i = static_cast<std::size_t>(k);
        verified[i] = placeNear(submap, almostSure(places[i]), strict);
    }
    std::vector<UncertainPose> found;
    for (const std::optional<UncertainPose>& place : verified) {
        if (!place) continue;
        const bool known =
            std::any_of(found.begin(), found.end(), [&](const UncertainPose& f) {
                return areOnePlace(f.T_a_b, place->T_a_b, kSamePlace_m);
            });
        if (!known) found.push_back(*place);
    }
    return found;
}

std::optional<UncertainPose> EarlierMap::placeNear(const FinishedSubmap& submap,
                                                   const UncertainPose& T_map_submap,
                                                   const ClosureParams& closure) const {
    const Map part = map_->crop(boxOf(submap.shape.surfaces_submap, T_map_submap));
    if (part.empty()) return std::nullopt;
    // What is known of a place counts by the distance from where it was seen: the part gets
    // its origin there. Whole metres keep cells of free space as they are.
    const Pose T_map_part{Eigen::Matrix3d::Identity(),
                          T_map_submap.T_a_b.t.array().round()};
    Submap piece(map_->params());
    piece.map.merge(part, T_map_part.inverse());
    ClosureParams oneWay = closure;
    oneWay.minOverlapBack = 0.0;  // the map shows more
    const UncertainPose guess{T_map_part.inverse() * T_map_submap.T_a_b,
                              T_map_submap.covariance};
    auto found = verifiedPose(FinishedSubmap(std::move(piece)), submap, guess, oneWay);
    if (!found) return std::nullopt;
    found->T_a_b = T_map_part * found->T_a_b;
    return found;
}

}  // namespace hgmm::slam
