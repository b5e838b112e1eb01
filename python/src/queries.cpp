#include <pybind11/stl.h>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "arrays.h"
#include "shared_map.h"

namespace hgmm::python {

namespace {

constexpr const char* kOccupancyDoc =
    R"(Occupied, free or unknown, with the distance to the surface and its variance (thesis 4.3).

points_map: shape (N, 3) [m]; a point that is not finite is unknown.
level: of the hierarchy, 0 the finest.

Returns an Occupancy of arrays of shape (N,). Raises ValueError for another shape and IndexError
for a level that does not exist. Uses all cores and releases the GIL.)";

constexpr const char* kAlongRayDoc =
    R"(The expected distance to the surface along the rays that saw a point, and its variance:
thesis eq. (4.17) and (4.18). It is no Euclidean distance.

points_map: shape (N, 3) [m].
level: of the hierarchy, 0 the finest.

Returns a Distance of arrays of shape (N,), NaN where no component reaches the point. Raises
ValueError for another shape and IndexError for a level that does not exist. Uses all cores and
releases the GIL.)";

constexpr const char* kDistanceDoc =
    R"(The Euclidean distance to the nearest surface, however it is seen. A component's surface is
a rectangle across its thinnest axis.

points_map: shape (N, 3) [m]; a point that is not finite has no answer.
max_distance: farther surfaces are not seen [m], in [1e-3, 1e6].
level: of the hierarchy, 0 the finest.

Returns a SurfaceDistance of arrays of shape (N,), the gradient of shape (N, 3). Raises
ValueError for another shape and a distance out of range, and IndexError for a level that does
not exist. Uses all cores and releases the GIL.)";

constexpr const char* kModalityDoc = R"(A modality at points: thesis eq. (5.6) and (5.7).

name: of a channel that the option modalities names.
points_map: shape (N, 3) [m]; a point that is not finite is not known.

Returns a Modality of arrays of shape (N,). Raises ValueError for a name that the map does not
model or another shape. Uses all cores and releases the GIL.)";

constexpr const char* kInferDoc =
    R"(Infers a modality from the values of others (thesis 5.2), at a place if it is given.

target: name of the modality to infer.
values: name -> value [unit of the channel] of the modalities that were measured.
point_map: shape (3,) [m], or None.

Returns an Inferred. Raises ValueError for names that the map does not model, no values at all,
or a value or point that is not finite. Releases the GIL.)";

constexpr const char* kCastRayDoc =
    R"(Follows a ray to the first surface whose P(occ) is high enough.

origin_map: shape (3,) [m].
direction_map: shape (3,), of any length but 0.
max_range: where the search ends [m], > 0.
min_occupied: P(occ) that stops the ray, in (0, 1).
stop_at_unknown: whether nothing is returned where P(unknown) exceeds 0.5 on the way.
level: of the hierarchy, 0 the finest.

Returns a RayHit, or None if nothing is met. Raises ValueError for another shape, a direction
that is zero or not finite and numbers out of range, and IndexError for a level that does not
exist. Releases the GIL.)";

Columns<Occupancy> askOccupancy(const SharedMap& map, const py::object& points_map,
                                std::size_t level) {
    const Points points(points_map, "points_map");
    Columns<Occupancy> answers(points.size());
    map.read([&](const Map& m) {
        m.occupancy(points.data(), points.size(), answers.data(), level);
    });
    return answers;
}

py::object occupancy(const SharedMap& map, const py::object& points_map,
                     std::size_t level) {
    return answer("Occupancy",
                  *askOccupancy(map, points_map, level)
                       .arrays(&Occupancy::occupied, &Occupancy::free, &Occupancy::unknown,
                               &Occupancy::alongRay_m, &Occupancy::variance_m2));
}

py::object alongRay(const SharedMap& map, const py::object& points_map, std::size_t level) {
    Columns<Occupancy> answers = askOccupancy(map, points_map, level);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (Occupancy& a : answers) {
        if (a.unknown >= 1.F || a.variance_m2 <= 0.F) a.alongRay_m = a.variance_m2 = nan;
    }
    return answer("Distance",
                  *answers.arrays(&Occupancy::alongRay_m, &Occupancy::variance_m2));
}

py::object distance(const SharedMap& map, const py::object& points_map,
                    double maxDistance_m, std::size_t level) {
    const Points points(points_map, "points_map");
    Columns<SurfaceDistance> answers(points.size());
    map.read([&](const Map& m) {
        m.distance(points.data(), points.size(), answers.data(), {maxDistance_m}, level);
    });
    return answer("SurfaceDistance",
                  *answers.arrays(&SurfaceDistance::distance_m, &SurfaceDistance::gradient,
                                  &SurfaceDistance::std_m, &SurfaceDistance::known));
}

py::object modality(const SharedMap& map, const std::string& name,
                    const py::object& points_map) {
    const Points points(points_map, "points_map");
    Columns<ModalityEstimate> answers(points.size());
    map.read([&](const Map& m) {
        m.modality(name, points.data(), points.size(), answers.data());
    });
    return answer("Modality",
                  *answers.arrays(&ModalityEstimate::mean, &ModalityEstimate::variance,
                                  &ModalityEstimate::known));
}

py::object infer(const SharedMap& map, const std::string& target,
                 const std::map<std::string, double>& values, const py::object& point_map) {
    std::vector<ModalityValue> priors;
    for (const auto& [name, value] : values) priors.push_back({name, value});
    std::optional<Eigen::Vector3d> point;
    if (!point_map.is_none()) point = vector3(point_map, "point_map");
    const CrossModalEstimate e =
        map.read([&](const Map& m) { return m.infer(target, priors, point); });
    return answer("Inferred", e.mean, e.variance, e.known, arrayOf(e.place_map),
                  e.likelihood);
}

py::object castRay(const SharedMap& map, const py::object& origin_map,
                   const py::object& direction_map, double maxRange_m, double minOccupied,
                   bool stopAtUnknown, std::size_t level) {
    const Eigen::Vector3d origin = vector3(origin_map, "origin_map");
    const Eigen::Vector3d direction = vector3(direction_map, "direction_map");
    const RayCastParams params{maxRange_m, minOccupied, stopAtUnknown};
    const auto hit =
        map.read([&](const Map& m) { return m.castRay(origin, direction, params, level); });
    if (!hit) return py::none();
    return answer("RayHit", hit->range_m, arrayOf(hit->point_map));
}

}  // namespace

void bindQueries(MapClass& map) {
    using namespace py::literals;
    map.def("occupancy", &occupancy, "points_map"_a, "level"_a = 0, kOccupancyDoc);
    map.def("along_ray", &alongRay, "points_map"_a, "level"_a = 0, kAlongRayDoc);
    map.def("distance", &distance, "points_map"_a, py::kw_only(),
            "max_distance"_a = DistanceParams().maxDistance_m, "level"_a = 0, kDistanceDoc);
    map.def("modality", &modality, "name"_a, "points_map"_a, kModalityDoc);
    map.def("infer", &infer, "target"_a, "values"_a, "point_map"_a = py::none(), kInferDoc);
    const RayCastParams ray;
    map.def("cast_ray", &castRay, "origin_map"_a, "direction_map"_a, py::kw_only(),
            "max_range"_a = ray.maxRange_m, "min_occupied"_a = ray.minOccupied,
            "stop_at_unknown"_a = ray.stopAtUnknown, "level"_a = 0, kCastRayDoc);
}

}  // namespace hgmm::python
