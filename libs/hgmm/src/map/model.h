#pragma once
#include <Eigen/Core>

#include "hgmm/map.h"
#include "hgmm/params.h"
#include "map/component_store.h"
#include "map/query_cache.h"
#include "modality/modalities.h"
#include "occupancy/coverage.h"
#include "occupancy/free_space.h"
#include "occupancy/openings.h"

namespace hgmm {

/// What a map is, and what is saved of it. All positions are in the local frame, whose
/// origin in the map frame is `origin` and whose axes are the map's.
struct Model {
    MapParams params;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m]
    ComponentStore components;
    FreeSpace freeSpace;
    Coverage coverage;
    Openings openings;
    Modalities modalities;

    /// Whether the local frame may still be anywhere.
    bool isBlank() const {
        return components.empty() && freeSpace.mixture().empty() && coverage.empty() &&
               modalities.groups().empty();
    }
    bool operator==(const Model& o) const;
};

/// The model, and what is computed from it when asked for. Copies share nothing and begin
/// with an empty cache; snapshots have what level 0 had.
struct Map::State {
    Model model;
    QueryCache cache{model};

    State() = default;
    explicit State(Model m) : model(std::move(m)) {}
    State(const State& o) : model(o.model) {}
    State(const State& o, const QueryCache& prepared)
        : model(o.model), cache(model, prepared) {}
    State& operator=(const State&) = delete;
};

}  // namespace hgmm
