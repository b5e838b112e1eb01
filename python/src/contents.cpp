#include <pybind11/stl.h>

#include <string>

#include "arrays.h"
#include "hgmm/sampling.h"
#include "options.h"
#include "shared_map.h"

namespace hgmm::python {

namespace {

constexpr const char* kMixtureDoc = R"(The surface components of a level in the map frame.

level: of the hierarchy, 0 the finest.

Returns a Mixture with D = 3. Raises IndexError for a level that does not exist. Releases the
GIL while upper levels are brought up to date.)";

constexpr const char* kFreeMixtureDoc =
    R"(The free-space components of a level over (X, W) (thesis 4.2): place in the map frame, and
distance to the surface along the rays.

level: of the hierarchy, 0 the finest.

Returns a Mixture with D = 4. Raises IndexError for a level that does not exist. Releases the
GIL while upper levels are brought up to date.)";

constexpr const char* kSampleDoc = R"(Draws points from the surfaces of a level.

n: how many. seed: the same seed gives the same points.
level: of the hierarchy, 0 the finest.

Returns shape (n, 3), float64, in the map frame [m]. Raises ValueError if the map has no
surface and n > 0, and IndexError for a level that does not exist. Releases the GIL.)";

constexpr const char* kInfoDoc = R"(What the map holds, as a dict:

origin_map: origin of the frame in which components are stored, shape (3,) [m]
points: that surfaces explain [count]
levels: a dict for each, with the number of surface and free components
modalities: name -> number of components
saved_bytes, live_bytes: size as saved compactly, and heap in use
options: name -> value, as in docs/options.md)";

/// A level's arrays, filled without the GIL.
template <int D>
struct LevelArrays {
    explicit LevelArrays(std::size_t n) : mean(n * D), covariance(n * D * D), support(n) {}
    std::vector<double> mean, covariance, support;
};

template <int D>
LevelArrays<D> arraysOf(const Mixture<D>& mixture, const Eigen::Vector3d& origin_map) {
    LevelArrays<D> arrays(mixture.size());
    double *mean = arrays.mean.data(), *covariance = arrays.covariance.data();
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        for (int a = 0; a < D; ++a) {
            *mean++ = mixture.mean[a][i] + (a < 3 ? origin_map[a] : 0.0);
            for (int b = 0; b < D; ++b)
                *covariance++ = mixture.covariance[packedIndex(D, a, b)][i];
        }
        arrays.support[i] = mixture.support[i];
    }
    return arrays;
}

/// The vector's own memory.
py::array_t<double> moved(std::vector<double>&& values, std::vector<py::ssize_t> shape) {
    auto* kept = new std::vector<double>(std::move(values));
    const py::capsule owner(kept,
                            [](void* p) { delete static_cast<std::vector<double>*>(p); });
    return py::array_t<double>(std::move(shape), kept->data(), owner);
}

template <int D>
py::object mixtureOf(LevelArrays<D>&& arrays) {
    const auto n = static_cast<py::ssize_t>(arrays.support.size());
    return answer("Mixture", moved(std::move(arrays.mean), {n, D}),
                  moved(std::move(arrays.covariance), {n, D, D}),
                  moved(std::move(arrays.support), {n}));
}

py::object mixture(const SharedMap& map, std::size_t level) {
    return mixtureOf(
        map.read([&](const Map& m) { return arraysOf(m.mixture(level), m.origin()); }));
}

py::object freeMixture(const SharedMap& map, std::size_t level) {
    return mixtureOf(
        map.read([&](const Map& m) { return arraysOf(m.freeMixture(level), m.origin()); }));
}

py::array_t<double> sample(const SharedMap& map, std::size_t n, std::uint64_t seed,
                           std::size_t level) {
    std::vector<double> points_map = map.read([&](const Map& m) {
        const std::vector<float> local = samplePoints(m.mixture(level), n, seed);
        std::vector<double> points(local.size());
        for (std::size_t i = 0; i < local.size(); ++i)
            points[i] = m.origin()[i % 3] + static_cast<double>(local[i]);
        return points;
    });
    return moved(std::move(points_map), {static_cast<py::ssize_t>(n), 3});
}

/// Numbers of a map that take a while.
struct Info {
    struct Level {
        std::size_t surface, free;
    };
    Eigen::Vector3d origin_map;
    double points;
    std::vector<Level> levels;
    std::vector<std::pair<std::string, std::size_t>> modalities;
    std::size_t savedBytes, liveBytes;
    MapParams params;
};

Info infoOf(const Map& m) {
    Info info{
        m.origin(), m.mixture().totalSupport(), {}, {}, m.save().size(), m.liveBytes(),
        m.params()};
    for (std::size_t level = 0; level < m.levelCount(); ++level)
        info.levels.push_back({m.mixture(level).size(), m.freeMixture(level).size()});
    for (const std::string& name : m.modalities()) {
        const ModalityMap* modality = m.modality(name);
        info.modalities.emplace_back(name, modality ? modality->size() : 0);
    }
    return info;
}

py::dict info(const SharedMap& map) {
    const Info found = map.read(infoOf);
    py::list levels;
    for (const Info::Level& level : found.levels) {
        py::dict counts;
        counts["surface"] = level.surface;
        counts["free"] = level.free;
        levels.append(counts);
    }
    py::dict modalities;
    for (const auto& [name, size] : found.modalities) modalities[name.c_str()] = size;
    py::dict all;
    all["origin_map"] = arrayOf(found.origin_map);
    all["points"] = found.points;
    all["levels"] = levels;
    all["modalities"] = modalities;
    all["saved_bytes"] = found.savedBytes;
    all["live_bytes"] = found.liveBytes;
    all["options"] = optionsOf(found.params);
    return all;
}

std::string text(const SharedMap& map) {
    return map.read([](const Map& m) {
        return "<hgmm.Map: " + std::to_string(m.mixture().size()) + " surface and " +
               std::to_string(m.freeMixture().size()) + " free-space components>";
    });
}

}  // namespace

void bindContents(MapClass& map) {
    using namespace py::literals;
    map.def("mixture", &mixture, "level"_a = 0, kMixtureDoc);
    map.def("free_mixture", &freeMixture, "level"_a = 0, kFreeMixtureDoc);
    map.def("sample", &sample, "n"_a, "seed"_a = 0, "level"_a = 0, kSampleDoc);
    map.def("info", &info, kInfoDoc);
    map.def_property_readonly(
        "options",
        [](const SharedMap& m) {
            return optionsOf(m.read([](const Map& it) { return it.params(); }));
        },
        "Options by name, as in docs/options.md; a copy.");
    map.def_property_readonly(
        "empty",
        [](const SharedMap& m) { return m.read([](const Map& it) { return it.empty(); }); },
        "Whether the map has no surface.");
    map.def_property_readonly(
        "coverage_bytes",
        [](const SharedMap& m) {
            return m.read([](const Map& it) { return it.coverageBytes(); });
        },
        "Size of what the map knows of where rays passed, as it is saved [bytes].");
    map.def("__repr__", &text);
}

}  // namespace hgmm::python
