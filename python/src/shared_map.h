#pragma once
#include <pybind11/pybind11.h>

#include <mutex>
#include <shared_mutex>
#include <utility>

#include "hgmm/map.h"

namespace hgmm::python {

/// A map that Python's threads share: while one of them changes it, no other reads it.
/// Locks are taken without the GIL, so that whoever waits keeps nobody else from running.
class SharedMap {
 public:
    explicit SharedMap(Map map) : map_(std::move(map)) {}

    /// read(map), without the GIL. It must return no Python object.
    template <typename Read>
    auto read(Read&& read) const {
        const pybind11::gil_scoped_release noGil;
        const std::shared_lock lock(mutex_);
        return read(map_);
    }
    /// change(map), without the GIL.
    template <typename Change>
    auto change(Change&& change) {
        const pybind11::gil_scoped_release noGil;
        const std::unique_lock lock(mutex_);
        return change(map_);
    }
    /// change(map, other's map), without the GIL. A map and itself: a copy is the other.
    template <typename Change>
    auto changeWith(const SharedMap& other, Change&& change) {
        if (&other == this)
            return this->change([&](Map& map) { return change(map, Map(map)); });
        const pybind11::gil_scoped_release noGil;
        std::unique_lock mine(mutex_, std::defer_lock);
        std::shared_lock theirs(other.mutex_, std::defer_lock);
        std::lock(mine, theirs);
        return change(map_, std::as_const(other.map_));
    }
    /// read(map, other's map), without the GIL.
    template <typename Read>
    auto readWith(const SharedMap& other, Read&& read) const {
        if (&other == this)
            return this->read([&](const Map& map) { return read(map, map); });
        const pybind11::gil_scoped_release noGil;
        std::shared_lock mine(mutex_, std::defer_lock);
        std::shared_lock theirs(other.mutex_, std::defer_lock);
        std::lock(mine, theirs);
        return read(map_, other.map_);
    }

 private:
    Map map_;
    mutable std::shared_mutex mutex_;
};

using MapClass = pybind11::class_<SharedMap>;

void bindBuilding(MapClass& map);
void bindRegistration(MapClass& map);
void bindQueries(MapClass& map);
void bindContents(MapClass& map);
void bindSaving(MapClass& map);

}  // namespace hgmm::python
