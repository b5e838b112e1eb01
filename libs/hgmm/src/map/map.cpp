#include "hgmm/map.h"

#include <utility>

#include "map/model.h"

namespace hgmm {

Map::Map(const MapParams& params) : state_(std::make_unique<State>()) {
    setParams(params);
}
Map::Map(const Map& o) : state_(std::make_unique<State>(*o.state_)) {}
// What is moved from is an empty map, not a broken one.
Map::Map(Map&& o) noexcept : Map() {
    state_.swap(o.state_);
}
Map& Map::operator=(const Map& o) {
    if (this != &o) state_ = std::make_unique<State>(*o.state_);
    return *this;
}
Map& Map::operator=(Map&& o) noexcept {
    if (this != &o) {
        Map empty;
        state_ = std::exchange(o.state_, std::move(empty.state_));
    }
    return *this;
}
Map::~Map() = default;

std::shared_ptr<const Map> Map::snapshot() const {
    // Asked for once, they follow the changes of this map.
    state_->cache.occupancy(0);
    auto copy = std::make_shared<Map>();
    copy->state_ = std::make_unique<State>(*state_, state_->cache);
    return copy;
}

const MapParams& Map::params() const {
    return state_->model.params;
}

void Map::setParams(const MapParams& params) {
    params.validate();
    state_->model.params = params;
    state_->model.modalities.configure(params);
    state_->cache.clear();
}

bool Map::empty() const {
    return state_->model.components.empty();
}

void Map::clear() {
    *this = Map(params());
}

const Eigen::Vector3d& Map::origin() const {
    return state_->model.origin;
}

std::size_t Map::liveBytes() const {
    const Model& model = state_->model;
    return sizeof(Map) + sizeof(State) + model.components.liveBytes() +
           model.freeSpace.liveBytes() + model.coverage.liveBytes() +
           model.openings.liveBytes() + model.modalities.liveBytes() +
           state_->cache.liveBytes();
}

bool Model::operator==(const Model& o) const {
    return params == o.params && origin == o.origin && components == o.components &&
           freeSpace == o.freeSpace && coverage == o.coverage && openings == o.openings &&
           modalities == o.modalities;
}

bool Map::operator==(const Map& o) const {
    return state_->model == o.state_->model;
}

}  // namespace hgmm
