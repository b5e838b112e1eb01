#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "base/lazy.h"
#include "hgmm/mixture.h"
#include "hgmm/view_directions.h"
#include "index/coarse_grid.h"
#include "index/component_index.h"
#include "index/surface_pyramid.h"
#include "map/component_store.h"
#include "map/levels.h"
#include "occupancy/occupancy_model.h"
#include "occupancy/patch_tree.h"

namespace hgmm {

struct Model;

/// What is computed from a model: indices, upper levels, factored components. The first
/// reader, const and possibly one of several threads, builds it; apply() keeps it up to
/// date from then on. What it says depends on the model alone, not on how that came about.
class QueryCache {
 public:
    /// @param model read whenever asked; must outlive the cache
    explicit QueryCache(const Model& model) : model_(model) {}
    /// For a copy of another cache's model, with what level 0 has there. Readers of the
    /// other one may go on meanwhile.
    QueryCache(const Model& model, const QueryCache& o);
    QueryCache(const QueryCache&) = delete;
    QueryCache& operator=(const QueryCache&) = delete;

    /// Components that contain a point, by their 4 sigma ellipsoids.
    const ComponentIndex& index() const { return indices().components; }
    /// The same of any level.
    const ComponentIndex& index(std::size_t level) const;
    /// Components whose means lie in a box.
    const CoarseGrid& grid() const { return indices().grid; }
    const SurfacePyramid& pyramid() const { return indices().pyramid; }
    double logTotalSupport() const;
    /// Upper levels, level >= 1.
    const Mixture<3>& mixture(std::size_t level) const;
    const ViewDirections& viewDirections(std::size_t level) const;
    const Mixture<4>& freeMixture(std::size_t level) const;
    const Coverage& coverage(std::size_t level) const;
    const OccupancyModel& occupancy(std::size_t level) const;
    /// Of any level. D = 2: those of horizontal marginals.
    template <int D>
    const PatchTree<D>& patches(std::size_t level) const;

    /// Follows the model. Not for concurrent use, as the model's changes are not.
    /// @param updatedFree rows of the free-space mixture that were altered or added, rising
    void apply(const Changes& changes, const std::vector<std::uint32_t>& updatedFree = {});
    /// Forgets everything, for a model of other parameters.
    void clear();

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    struct Indices {
        ComponentIndex components;
        CoarseGrid grid;
        SurfacePyramid pyramid;

        Eigen::Vector3f mean(std::uint32_t i) const;
        void update(const Mixture<3>& base, std::uint32_t i);
        void truncate(std::size_t n);
    };
    struct Level {
        ViewDirections viewDirections;
        Mixture<4> free;
        Coverage coverage;
        bool hasFeatures = false;    ///< the above are there; upper levels only
        Lazy<ComponentIndex> index;  ///< upper levels only
        Lazy<OccupancyModel> occupancy;
        Lazy<PatchTree<2>> patches2D;
        Lazy<PatchTree<3>> patches3D;

        std::size_t liveBytes() const;
    };

    const Indices& indices() const;
    Level& levelAt(std::size_t level) const;
    Level& upperLevel(std::size_t level) const;
    /// What it reads.
    OccupancyModel::Surfaces surfaces(std::size_t level) const;
    std::unique_ptr<OccupancyModel> makeOccupancy(std::size_t level) const;

    const Model& model_;
    mutable Lazy<Indices> indices_;
    mutable Lazy<double> logTotalSupport_;
    mutable Lazy<std::vector<std::unique_ptr<Level>>> levels_;
    mutable std::mutex levelsMutex_;  ///< guards blocks_ and features of upper levels
    mutable LevelBlocks blocks_;
};

}  // namespace hgmm
