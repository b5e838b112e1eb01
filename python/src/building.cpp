#include <pybind11/stl.h>

#include <cmath>
#include <string>

#include "arrays.h"
#include "options.h"
#include "shared_map.h"

namespace hgmm::python {

namespace {

constexpr const char* kInitDoc = R"(An empty map.

Options are keywords, those of the section insertOpts in docs/options.md that are no matter of
MRPT's observations. Lengths that are not given follow resolution_m. modalities is a list of
names, or a text with commas; rgb is short for r, g, b.

Raises TypeError for a name that there is not, with the nearest, or for a value of the wrong
type, and ValueError for a value out of range.)";

constexpr const char* kInsertDoc = R"(Adds a scan: thesis chapter 3, and 4 for free space.

points_sensor: shape (N, 3), in the sensor frame [m]; rays start at its origin. Points that
    are not finite are dropped and counted. float32 in C order is read where it is.
T_map_sensor: shape (4, 4), the pose of the sensor in the map [m]; None for the identity.
channels: name -> shape (N,), what else was measured at each point; colours and intensities in
    [0, 1]. Those that the option modalities does not name are ignored.
cleared_rays_sensor: shape (M, 3), rays that saw nothing, as vectors from the sensor to where
    they are known to be free [m]. They clear space and mark nothing at their end; one of no
    length clears nothing.

Returns an InsertReport. Raises ValueError for wrong shapes and for a pose that is not finite or
not rigid; the map is unchanged then. Releases the GIL.)";

constexpr const char* kMergeDoc =
    R"(Adds what another map knows. This map's options and frame stay.

T_this_other: shape (4, 4), the pose of the other map's frame in this one's [m]; None for the
    identity.

A surface component joins the one that it resembles most, or is added. Free space joins cell by
cell. Raises ValueError for a pose that is not finite or not rigid. Releases the GIL.)";

constexpr const char* kForgetDoc =
    R"(Removes surface components whose means lie in a box, for what is known to be gone.

low, high: shape (3,), corners in the map frame [m]. Free space and modalities stay.

Returns how many were removed. Raises ValueError for a box that is empty or not finite.)";

constexpr const char* kCropDoc =
    R"(The part of this map that answers within a box, as a map of its own in the same frame.

low, high: shape (3,), corners in the map frame [m].

Within the box, occupancy of level 0 and modality, where it is known, are those of this map, bit
for bit; distances are where the surface is not farther than the faces of the box. Raises
ValueError for a box that is empty or not finite. Releases the GIL.)";

std::vector<float> floats(const py::array_t<float>& array) {
    return {array.data(), array.data() + array.size()};
}

void setPoints(const py::object& argument, Scan& scan) {
    const auto points = numbers<float>(argument, "points_sensor", -1, 3);
    const auto n = static_cast<std::size_t>(points.shape(0));
    const float* p = points.data();
    scan.reserve(n);
    for (std::size_t i = 0; i < n; ++i, p += 3) scan.pushBack(p[0], p[1], p[2]);
}

void setClearedRays(const py::object& argument, Scan& scan) {
    if (argument.is_none()) return;
    const Points rays(argument, "cleared_rays_sensor");
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Eigen::Vector3d& ray = rays.data()[i];
        if (!ray.allFinite())
            throw py::value_error("cleared_rays_sensor: ray " + std::to_string(i) +
                                  " is not finite");
        const double length_m = ray.norm();
        if (length_m > 0)
            scan.clearedRays.push_back(
                {(ray / length_m).cast<float>(), static_cast<float>(length_m)});
    }
}

py::object insert(SharedMap& map, const py::object& points_sensor,
                  const py::object& T_map_sensor, const py::dict& channels,
                  const py::object& clearedRays_sensor) {
    Scan scan;
    setPoints(points_sensor, scan);
    for (const auto& [name, values] : channels) {
        if (!py::isinstance<py::str>(name))
            throw py::type_error("channels: expected names as keys, got " +
                                 py::repr(name).cast<std::string>());
        const auto text = name.cast<std::string>();
        scan.channels.push_back(
            {text, floats(numbers<float>(values, "channels['" + text + "']",
                                         static_cast<py::ssize_t>(scan.size()), 0))});
    }
    setClearedRays(clearedRays_sensor, scan);
    scan.T_map_sensor = poseFrom(T_map_sensor, "T_map_sensor");
    const InsertReport r = map.change([&](Map& m) { return m.insert(scan); });
    return answer("InsertReport", r.points.used, r.points.notFinite, r.points.tooNear,
                  r.points.cut, r.samples, r.novelSamples, r.componentsUpdated,
                  r.componentsAdded, r.componentsMissed, r.componentsCarved,
                  r.componentsOversized, r.componentsRemoved);
}

void merge(SharedMap& map, const SharedMap& other, const py::object& T_this_other) {
    const Pose pose = poseFrom(T_this_other, "T_this_other");
    map.changeWith(other, [&](Map& m, const Map& o) { m.merge(o, pose); });
}

std::size_t forget(SharedMap& map, const py::object& low, const py::object& high) {
    const Eigen::AlignedBox3d box_map(vector3(low, "low"), vector3(high, "high"));
    return map.change([&](Map& m) { return m.forget(box_map); });
}

std::unique_ptr<SharedMap> crop(const SharedMap& map, const py::object& low,
                                const py::object& high) {
    const Eigen::AlignedBox3d box_map(vector3(low, "low"), vector3(high, "high"));
    return std::make_unique<SharedMap>(
        map.read([&](const Map& m) { return m.crop(box_map); }));
}

}  // namespace

void bindBuilding(MapClass& map) {
    using namespace py::literals;
    map.def(py::init([](const py::kwargs& options) {
                return std::make_unique<SharedMap>(Map(paramsFrom(options)));
            }),
            kInitDoc);
    map.def("insert", &insert, "points_sensor"_a, "T_map_sensor"_a = py::none(),
            "channels"_a = py::dict(), "cleared_rays_sensor"_a = py::none(), kInsertDoc);
    map.def("merge", &merge, "other"_a, "T_this_other"_a = py::none(), kMergeDoc);
    map.def("forget", &forget, "low"_a, "high"_a, kForgetDoc);
    map.def("crop", &crop, "low"_a, "high"_a, kCropDoc);
    map.def(
        "clear", [](SharedMap& m) { m.change([](Map& it) { it.clear(); }); },
        "Forgets everything but the options.");
}

}  // namespace hgmm::python
