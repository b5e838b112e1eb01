#include "map/component_store.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/growth.h"

namespace hgmm {

ComponentStore::ComponentStore(Mixture<3> surfaces, ViewDirections viewDirections)
    : surfaces_(std::move(surfaces)), viewDirections_(std::move(viewDirections)) {
    if (surfaces_.size() != viewDirections_.size())
        throw std::logic_error("ComponentStore: rows differ in number");
}

std::uint32_t ComponentStore::add(const Gaussian<3>& component, const ViewDirection& view) {
    const auto i = static_cast<std::uint32_t>(size());
    if (i == surfaces_.support.capacity()) {
        surfaces_.reserve(roomFor(i + std::size_t{1}));
        viewDirections_.reserve(roomFor(i + std::size_t{1}));
    }
    surfaces_.pushBack(component);
    viewDirections_.pushBack(view);
    updated_.push_back(i);
    return i;
}

void ComponentStore::set(std::uint32_t i, const Gaussian<3>& component,
                         const ViewDirection& view) {
    surfaces_.set(i, component);
    viewDirections_.set(i, view);
    updated_.push_back(i);
}

void ComponentStore::setSupport(std::uint32_t i, float support) {
    surfaces_.support.at(i) = support;
    updated_.push_back(i);
}

void ComponentStore::remove(std::uint32_t i) {
    surfaces_.removeSwap(i);
    viewDirections_.removeSwap(i);
    updated_.push_back(i);
}

Changes ComponentStore::takeChanges() {
    Changes changes{size(), std::exchange(updated_, {})};
    std::vector<std::uint32_t>& rows = changes.updated;
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    rows.erase(std::lower_bound(rows.begin(), rows.end(), changes.size), rows.end());
    return changes;
}

std::size_t ComponentStore::liveBytes() const {
    constexpr std::size_t viewFloats = 4;
    return surfaces_.support.capacity() * sizeof(float) *
               (1 + 3 + Mixture<3>::packed + viewFloats) +
           updated_.capacity() * sizeof(std::uint32_t);
}

}  // namespace hgmm
