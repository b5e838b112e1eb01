#include <cstdint>

#include "hgmm/map.h"
#include "map/model.h"
#include "map/require_box.h"

namespace hgmm {

std::size_t Map::forget(const Eigen::AlignedBox3d& box_map) {
    requireBox(box_map, "forget");
    Model& model = state_->model;
    ComponentStore& store = model.components;
    const std::size_t before = store.size();
    // Falling, for remove() puts the last row into the place of the removed one.
    for (auto i = static_cast<std::uint32_t>(before); i-- > 0;) {
        const auto& mean = store.surfaces().mean;
        const Eigen::Vector3d mean_local(mean[0][i], mean[1][i], mean[2][i]);
        if (box_map.contains(mean_local + model.origin)) store.remove(i);
    }
    state_->cache.apply(store.takeChanges());
    return before - store.size();
}

}  // namespace hgmm
