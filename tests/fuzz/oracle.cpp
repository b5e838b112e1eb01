#include "oracle.h"

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace hgmm::fuzz {

namespace {

/// Points in a map's frame: of components, beside them, and anywhere.
std::vector<Eigen::Vector3d> pointsAround(const Map& map, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    const auto vector = [&] {
        return Eigen::Vector3d(normal(random), normal(random), normal(random));
    };
    std::vector<Eigen::Vector3d> points = {map.origin(), map.origin() + 1e9 * vector(),
                                           1e30 * vector()};
    const Mixture<3>& base = map.mixture();
    for (int k = 0; k < 12; ++k) {
        if (base.empty()) {
            points.push_back(map.origin() + 10 * vector());
            continue;
        }
        const Gaussian<3> g = base[random() % base.size()];
        const double reach = k % 3 == 0 ? 0.0 : k % 3 == 1 ? 2.0 : 20.0;
        const Eigen::Vector3d beside =
            g.covariance.diagonal().cwiseSqrt().cwiseProduct(reach * vector());
        points.push_back(map.origin() + g.mean + beside);
    }
    return points;
}

bool same(const Occupancy& a, const Occupancy& b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

bool same(const SurfaceDistance& a, const SurfaceDistance& b) {
    return a.distance_m == b.distance_m && a.gradient == b.gradient && a.std_m == b.std_m &&
           a.component == b.component && a.known == b.known;
}

bool same(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
    return a.has_value() == b.has_value() &&
           (!a || (a->range_m == b->range_m && a->point_map == b->point_map));
}

void requireDistribution(const Occupancy& o) {
    for (const float p : {o.occupied, o.free, o.unknown})
        require(p >= 0.F && p <= 1.F, "a probability is in [0, 1]");
    require(std::abs(o.occupied + o.free + o.unknown - 1.F) < 1e-5F,
            "probabilities sum to one");
    require(std::isfinite(o.alongRay_m), "a distance along the ray is finite");
    require(std::isfinite(o.variance_m2) && o.variance_m2 >= 0.F,
            "a variance of distance is finite and not negative");
}

void requireSameAt(const Map& map, const Map& fresh, const Eigen::Vector3d& p,
                   std::size_t level) {
    const Occupancy o = map.occupancy(p, level);
    requireDistribution(o);
    require(same(o, fresh.occupancy(p, level)), "occupancy is that of fresh caches");
    require(map.occupancyGradient(p, level).allFinite(), "a gradient is finite");
    const SurfaceDistance d = map.distance(p, {}, level);
    require(std::isfinite(d.distance_m) && d.distance_m >= 0.0 && d.gradient.allFinite() &&
                std::isfinite(d.std_m),
            "a distance is finite");
    require(same(d, fresh.distance(p, {}, level)), "distance is that of fresh caches");
    const double hit = map.collision(Capsule{p, p, 0.3}, {}, level).probability;
    require(hit >= 0.0 && hit <= 1.0, "a probability of collision is in [0, 1]");
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-0.5, 0.3, 0.1)}) {
        const auto ray = map.castRay(p, direction, {}, level);
        require(!ray || (ray->range_m >= 0.0 && ray->point_map.allFinite()),
                "a hit is finite");
        require(same(ray, fresh.castRay(p, direction, {}, level)),
                "a ray's hit is that of fresh caches");
    }
}

void requireModalitiesAt(const Map& map, const Map& fresh, const Eigen::Vector3d& p) {
    for (const std::string& name : map.modalities()) {
        const ModalityEstimate a = map.modality(name, p), b = fresh.modality(name, p);
        require(std::isfinite(a.mean) && std::isfinite(a.variance) && a.variance >= 0.0,
                "an estimate of a modality is finite");
        require(a.mean == b.mean && a.variance == b.variance && a.known == b.known,
                "an estimate of a modality is that of fresh caches");
        const CrossModalEstimate inferred = map.infer(name, {{name, a.mean}}, p);
        require(std::isfinite(inferred.mean) && std::isfinite(inferred.variance),
                "an inferred modality is finite");
    }
}

}  // namespace

void requireSoundAnswers(const Map& map, std::uint64_t seed) {
    const Map fresh(map);
    require(fresh == map, "a copy equals its original");
    const std::vector<Eigen::Vector3d> points = pointsAround(map, seed);
    const std::size_t upper = seed % map.levelCount();
    for (std::size_t k = 0; k < points.size(); ++k) {
        const std::size_t level = k % 4 == 3 ? upper : 0;
        requireSameAt(map, fresh, points[k], level);
        require(!std::isnan(map.logDensity(points[k])), "a density is a number");
        require(map.logDensity(points[k]) == fresh.logDensity(points[k]),
                "density is that of fresh caches");
        requireModalitiesAt(map, fresh, points[k]);
    }
    require(map.mixture(upper) == fresh.mixture(upper) &&
                map.freeMixture(upper) == fresh.freeMixture(upper) &&
                map.viewDirections(upper) == fresh.viewDirections(upper),
            "a level is that of fresh caches");
}

void requireStableSaving(const Map& map) {
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        map.mixture(level).check();
        map.freeMixture(level).check();
    }
    const std::vector<std::uint8_t> exact = map.save(Encoding::exact);
    const Map loaded = Map::load(exact.data(), exact.size());
    require(loaded == map, "a map that was saved exactly comes back equal");
    require(loaded.save(Encoding::exact) == exact,
            "a map that was saved exactly saves to the same buffer");
    const std::vector<std::uint8_t> compact = map.save();
    require(Map::load(compact.data(), compact.size()).save() == compact,
            "a map from a compact buffer saves to the same buffer");
}

}  // namespace hgmm::fuzz
