#include "components.h"

namespace equality {
namespace {

/// View directions by either name: `viewDirections`, and `views` as it was before.
template <typename Map>
auto viewsOf(const Map& map, std::size_t level, int)
    -> decltype((map.viewDirections(level))) {
    return map.viewDirections(level);
}
template <typename Map>
auto viewsOf(const Map& map, std::size_t level, long) -> decltype((map.views(level))) {
    return map.views(level);
}

template <int D>
std::vector<std::string> columnsOf() {
    const std::string axes = "xyzw";
    std::vector<std::string> columns = {"support"};
    for (std::size_t a = 0; a < D; ++a) columns.push_back(std::string("mean ") + axes[a]);
    for (std::size_t a = 0; a < D; ++a)
        for (std::size_t b = a; b < D; ++b)
            columns.push_back(std::string("covariance ") + axes[a] + axes[b]);
    return columns;
}

template <int D>
void addMixture(Dump& dump, const std::string& name, const hgmm::Mixture<D>& mixture) {
    std::vector<float> values;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        values.push_back(mixture.support[i]);
        for (const auto& axis : mixture.mean) values.push_back(axis[i]);
        for (const auto& entry : mixture.covariance) values.push_back(entry[i]);
    }
    dump.add(name, Kind::components, "component", columnsOf<D>(), values);
}

void addViewDirections(Dump& dump, const std::string& name, const hgmm::Map& map,
                       std::size_t level) {
    const auto& views = viewsOf(map, level, 0);
    std::vector<float> values;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto& [direction, range_m] = views[i];
        for (int axis = 0; axis < 3; ++axis)
            values.push_back(static_cast<float>(direction[axis]));
        values.push_back(static_cast<float>(range_m));
    }
    dump.add(name, Kind::components, "view",
             {"direction x", "direction y", "direction z", "range"}, values);
}

}  // namespace

void addComponents(Dump& dump, const std::string& of, const hgmm::Map& map) {
    const Eigen::Vector3d& origin = map.origin();
    dump.add(of + "origin", Kind::components, "map", {"x", "y", "z"},
             std::vector<double>{origin.x(), origin.y(), origin.z()});
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        const std::string at = ", level " + std::to_string(level);
        addMixture(dump, of + "surfaces" + at, map.mixture(level));
        addViewDirections(dump, of + "view directions" + at, map, level);
        addMixture(dump, of + "free space" + at, map.freeMixture(level));
        for (const std::string& name : map.modalities())
            if (const auto* model = map.modality(name))
                addMixture(dump, of + "modality " + name + at, model->mixture(level));
    }
}

}  // namespace equality
