#include <Eigen/Geometry>
#include <cstdint>
#include <utility>

#include "base/power_of_two.h"
#include "hgmm/map.h"
#include "index/box_index.h"
#include "index/component_index.h"
#include "map/model.h"
#include "map/require_box.h"
#include "occupancy/occupancy_model.h"

namespace hgmm {

namespace {

/// Free components of one cell reach at most so many of its edges beyond it: the slabs that
/// they are made of are half an edge long. A cell is kept or dropped as one, so that crops
/// of two maps merge as the maps do.
constexpr double kFreeReachCells = 2.0;

/// What of a model counts within a box, in the local frame.
class Crop {
 public:
    Crop(const Model& model, const Eigen::AlignedBox3d& box)
        : model_(model), box_(box), corners_(box.cast<float>()) {}

    Model operator()() const {
        Model part;
        part.params = model_.params;
        part.origin = model_.origin;
        model_.coverage.copyAround(box_, part.coverage);
        Coverage openings, once;
        model_.openings.cells().copyAround(box_, openings);
        model_.openings.once().copyAround(box_, once);
        part.openings = Openings(std::move(openings), std::move(once));
        part.components = surfaces(part.coverage);
        part.freeSpace = freeSpace();
        part.modalities = model_.modalities.within(corners_);
        return part;
    }

 private:
    bool reaches(const BoxCells::Box& box) const {
        return BoxCells::of(box).meet(corners_.min().data(), corners_.max().data());
    }

    /// Coverage is also asked behind surfaces that reach the box.
    ComponentStore surfaces(Coverage& coverage) const {
        Mixture<3> kept;
        ViewDirections views;
        const Mixture<3>& all = model_.components.surfaces();
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Gaussian<3> surface = all[i];
            const ViewDirection view = model_.components.viewDirections()[i];
            const OccupancyParams& params = model_.params.occupancy;
            if (!reaches(OccupancyModel::reachOf(params, surface, view)) &&
                !ellipsoids_.reaches(surface, corners_))
                continue;
            kept.pushBack(surface);
            views.pushBack(view);
            const Eigen::Vector3d beyond = OccupancyModel::beyond(params, surface, view);
            model_.coverage.copyAround({beyond, beyond}, coverage);
        }
        return {std::move(kept), std::move(views)};
    }

    FreeSpace freeSpace() const {
        FreeSpace kept;
        const FreeSpace& all = model_.freeSpace;
        for (std::size_t i = 0; i < all.mixture().size(); ++i) {
            const Gaussian<4> component = all.mixture()[i];
            if (reaches(OccupancyModel::reachOf(component)) ||
                isNear(component.mean.head<3>(), all.octave(i)))
                kept.pushBack(component, all.octave(i));
        }
        return kept;
    }

    /// Whether the box is within the reach of the cell of a free component.
    bool isNear(const Eigen::Vector3d& mean, int octave) const {
        const LatticeCell cell = LatticeCell::at(mean, octave);
        const double edge = powerOfTwo(octave);
        const Eigen::Vector3d low = edge * Eigen::Vector3d(cell.x, cell.y, cell.z);
        const Eigen::Vector3d reach = Eigen::Vector3d::Constant(kFreeReachCells * edge);
        return box_.intersects(
            {low - reach, low + Eigen::Vector3d::Constant(edge) + reach});
    }

    const Model& model_;
    const Eigen::AlignedBox3d box_;
    const Eigen::AlignedBox3f corners_;
    const ComponentIndex ellipsoids_;
};

}  // namespace

Map Map::crop(const Eigen::AlignedBox3d& box_map) const {
    requireBox(box_map, "crop");
    Map part;
    part.state_ = std::make_unique<State>(
        Crop(state_->model, {box_map.min() - origin(), box_map.max() - origin()})());
    return part;
}

}  // namespace hgmm
