#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/require_rigid.h"
#include "cell_map/cell_surfaces.h"
#include "cell_map/free_cells.h"
#include "hgmm/hierarchy.h"
#include "hgmm/known_cells.h"
#include "hgmm/map.h"
#include "map/model.h"
#include "mixture/regularized.h"

namespace hgmm {

namespace {

/// The local frame begins in the middle of what is known, on the lattice of whole metres.
/// Throws std::invalid_argument if that reaches farther than maps go.
Eigen::Vector3d originFor(const Eigen::AlignedBox3d& known_map) {
    if (!(known_map.min().cwiseAbs().maxCoeff() <= kMaxPosition_m &&
          known_map.max().cwiseAbs().maxCoeff() <= kMaxPosition_m))
        throw std::invalid_argument("reaches farther than 1e8 m from the origin");
    return known_map.center().array().round();
}

Eigen::AlignedBox3d extentOf(const KnownCells& cells) {
    Eigen::AlignedBox3d extent;
    for (const auto* cubes : {&cells.occupied, &cells.free})
        for (const CellCube& cube : *cubes) {
            const Eigen::Vector3d low(cube.low[0], cube.low[1], cube.low[2]);
            for (const double end : {0.0, double(cube.size)})
                extent.extend(cells.T_map_cells.R *
                                  ((low.array() + end) * cells.edge_m).matrix() +
                              cells.T_map_cells.t);
        }
    return extent;
}

CellSet setOf(const std::vector<CellCube>& cubes) {
    CellSet set;
    for (const CellCube& cube : cubes) set.add(cube);
    return set;
}

void append(const Mixture<3>& fitted, const ViewDirection& view, Mixture<3>& surfaces,
            ViewDirections& views) {
    for (std::size_t i = 0; i < fitted.size(); ++i) {
        surfaces.pushBack(regularized(fitted[i]));
        views.pushBack(view);
    }
}

}  // namespace

void KnownCells::validate() const {
    if (!(edge_m >= 1e-3 && edge_m <= 100))
        throw std::invalid_argument("the edge of a cell must be in [0.001, 100] m");
    requireRigid(T_map_cells, "T_map_cells");
    for (const auto* cubes : {&occupied, &free})
        for (const CellCube& cube : *cubes) {
            if (cube.size < 1) throw std::invalid_argument("a cube has no cells");
            for (const std::int32_t c : cube.low)
                if (c < -kFarthest || c > kFarthest || cube.size > kFarthest)
                    throw std::invalid_argument("a cell is too far away");
        }
}

Map Map::fromCells(const KnownCells& cells, const MapParams& params) {
    cells.validate();
    Map map(params);
    Model& model = map.state_->model;
    if (cells.occupied.empty() && cells.free.empty()) return map;
    model.origin = originFor(extentOf(cells));
    const Pose T_local_cells{cells.T_map_cells.R, cells.T_map_cells.t - model.origin};
    const CellSet occupied = setOf(cells.occupied);
    CellSet free = setOf(cells.free);
    free.subtract(occupied);

    // As if from where a leaf of the filter is as large as a cell.
    const double roots = cells.edge_m / params.filter.resolution_m, range_m = roots * roots;
    Mixture<3> surfaces;
    ViewDirections views;
    // Without Algorithm 1: larger components would reach past the ends of walls.
    for (const CellSamples& side : outerFaces(occupied, free, cells.edge_m, T_local_cells))
        append(fitSurfaces(side, params.em),
               {side.direction, side.direction.isZero() ? 0.0 : range_m}, surfaces, views);
    model.components = ComponentStore(std::move(surfaces), std::move(views));
    model.freeSpace = freeComponents(occupied, free, cells.edge_m, T_local_cells);
    model.coverage = coverageOf(free, cells.edge_m, T_local_cells);
    return map;
}

Map Map::fromPoints(const std::vector<Eigen::Vector3d>& points_map,
                    const MapParams& params) {
    Map map(params);
    Eigen::AlignedBox3d extent;
    for (const Eigen::Vector3d& p : points_map)
        if (p.allFinite()) extent.extend(p);
    if (extent.isEmpty()) return map;
    Model& model = map.state_->model;
    model.origin = originFor(extent);
    const double edge_m = params.filter.resolution_m;
    if (!(extent.sizes().maxCoeff() / edge_m < KnownCells::kFarthest))
        throw std::invalid_argument("points are too far apart for resolution_m");
    std::vector<Eigen::Vector3d> points_local;
    points_local.reserve(points_map.size());
    for (const Eigen::Vector3d& p : points_map)
        if (p.allFinite()) points_local.push_back(p - model.origin);
    Mixture<3> surfaces;
    ViewDirections views;
    HierarchyParams toThreshold = params.hierarchy;
    toThreshold.levels = 1;
    const Mixture<3> fitted = fitSurfaces(
        pointSamples(points_local, edge_m, params.filter.noiseStd_m), params.em);
    append(generateHierarchy(fitted, toThreshold).levels.front(), {}, surfaces, views);
    model.components = ComponentStore(std::move(surfaces), std::move(views));
    return map;
}

}  // namespace hgmm
