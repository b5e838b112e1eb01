#include "map/query_cache.h"

#include <cmath>

#include "map/model.h"

namespace hgmm {

namespace {

/// View directions of a level: those of the base components that went into each of its
/// components.
ViewDirections viewDirectionsOfLevel(const ComponentStore& base,
                                     const std::vector<std::uint32_t>& parentOf,
                                     std::size_t size) {
    std::vector<ViewDirection> sums(size);
    std::vector<double> supports(size, 0.0);
    for (std::size_t i = 0; i < base.size(); ++i) {
        const std::uint32_t parent = parentOf[i];
        const ViewDirection view = base.viewDirections()[i];
        const float support = base.surfaces().support[i];
        sums[parent] = supports[parent] > 0
                           ? merged(sums[parent], supports[parent], view, support)
                           : view;
        supports[parent] += support;
    }
    ViewDirections level;
    for (const ViewDirection& view : sums) level.pushBack(view);
    return level;
}

}  // namespace

QueryCache::QueryCache(const Model& model, const QueryCache& o)
    : model_(model), indices_(o.indices_), logTotalSupport_(o.logTotalSupport_) {
    {
        const std::lock_guard<std::mutex> lock(o.levelsMutex_);
        blocks_ = o.blocks_;
    }
    const auto* const levels = o.levels_.ready();
    if (levels == nullptr) return;
    if (const OccupancyModel* const made = levels->front()->occupancy.ready())
        levelAt(0).occupancy.get([&] {
            return std::make_unique<OccupancyModel>(*made, surfaces(0), model.coverage,
                                                    model.openings);
        });
}

/// A component's mean as its index has it, which is that of its row before the change.
Eigen::Vector3f QueryCache::Indices::mean(std::uint32_t i) const {
    const ComponentIndex::Factor& factor = components.factor(i);
    return {factor.mean(0), factor.mean(1), factor.mean(2)};
}

void QueryCache::Indices::update(const Mixture<3>& base, std::uint32_t i) {
    const Eigen::Vector3f now(base.mean[0][i], base.mean[1][i], base.mean[2][i]);
    if (i < components.size()) {
        const Eigen::Vector3f before = mean(i);
        grid.move(i, before, now);
        pyramid.move(before, now);
    } else {
        grid.add(i, now);
        pyramid.add(now);
    }
    components.update(base, i);
}

std::size_t QueryCache::Level::liveBytes() const {
    std::size_t bytes = viewDirections.size() * 4 * sizeof(float) +
                        free.size() * sizeof(float) * (1 + 4 + Mixture<4>::packed);
    if (const ComponentIndex* made = index.ready()) bytes += made->liveBytes();
    if (const OccupancyModel* made = occupancy.ready()) bytes += made->liveBytes();
    if (const PatchTree<2>* made = patches2D.ready()) bytes += made->liveBytes();
    if (const PatchTree<3>* made = patches3D.ready()) bytes += made->liveBytes();
    return bytes;
}

void QueryCache::Indices::truncate(std::size_t n) {
    for (auto i = static_cast<std::uint32_t>(components.size()); i-- > n;) {
        grid.remove(i, mean(i));
        pyramid.remove(mean(i));
    }
    components.truncate(n);
}

const QueryCache::Indices& QueryCache::indices() const {
    return indices_.get([this] {
        const Mixture<3>& base = model_.components.surfaces();
        auto made = std::make_unique<Indices>();
        made->pyramid =
            SurfacePyramid(FreeSpace::pyramidOctave(model_.params.occupancy.freeSpace));
        made->components.reserve(base.size());
        for (std::uint32_t i = 0; i < base.size(); ++i) made->update(base, i);
        return made;
    });
}

const ComponentIndex& QueryCache::index(std::size_t level) const {
    if (level == 0) return index();
    return levelAt(level).index.get([this, level] {
        auto made = std::make_unique<ComponentIndex>();
        made->rebuild(mixture(level));
        return made;
    });
}

double QueryCache::logTotalSupport() const {
    return logTotalSupport_.get([this] {
        return std::make_unique<double>(
            std::log(model_.components.surfaces().totalSupport()));
    });
}

QueryCache::Level& QueryCache::levelAt(std::size_t level) const {
    const auto& levels = levels_.get([this] {
        auto made = std::make_unique<std::vector<std::unique_ptr<Level>>>();
        for (int l = 0; l < model_.params.hierarchy.levels; ++l)
            made->push_back(std::make_unique<Level>());
        return made;
    });
    return *levels[level];
}

const Mixture<3>& QueryCache::mixture(std::size_t level) const {
    const std::lock_guard<std::mutex> lock(levelsMutex_);
    return blocks_.levels(model_.components.surfaces(), model_.params.hierarchy)[level - 1];
}

/// Under the lock.
QueryCache::Level& QueryCache::upperLevel(std::size_t level) const {
    Level& upper = levelAt(level);
    if (upper.hasFeatures) return upper;
    const std::size_t size =
        blocks_.levels(model_.components.surfaces(), model_.params.hierarchy)[level - 1]
            .size();
    upper.viewDirections =
        viewDirectionsOfLevel(model_.components, blocks_.parentOf(level), size);
    upper.free = model_.freeSpace.coarsened(static_cast<int>(level));
    upper.coverage = model_.coverage.coarsened(static_cast<int>(level + 1) / 2);
    upper.hasFeatures = true;
    return upper;
}

const ViewDirections& QueryCache::viewDirections(std::size_t level) const {
    const std::lock_guard<std::mutex> lock(levelsMutex_);
    return upperLevel(level).viewDirections;
}

const Mixture<4>& QueryCache::freeMixture(std::size_t level) const {
    const std::lock_guard<std::mutex> lock(levelsMutex_);
    return upperLevel(level).free;
}

const Coverage& QueryCache::coverage(std::size_t level) const {
    const std::lock_guard<std::mutex> lock(levelsMutex_);
    return upperLevel(level).coverage;
}

const OccupancyModel& QueryCache::occupancy(std::size_t level) const {
    return levelAt(level).occupancy.get([this, level] { return makeOccupancy(level); });
}

template <int D>
const PatchTree<D>& QueryCache::patches(std::size_t level) const {
    const auto make = [this, level] {
        return std::make_unique<PatchTree<D>>(level == 0 ? model_.components.surfaces()
                                                         : mixture(level));
    };
    if constexpr (D == 2)
        return levelAt(level).patches2D.get(make);
    else
        return levelAt(level).patches3D.get(make);
}

template const PatchTree<2>& QueryCache::patches<2>(std::size_t) const;
template const PatchTree<3>& QueryCache::patches<3>(std::size_t) const;

OccupancyModel::Surfaces QueryCache::surfaces(std::size_t level) const {
    if (level == 0)
        return {model_.components.surfaces(), model_.components.viewDirections(), index()};
    return {mixture(level), viewDirections(level), index(level)};
}

std::unique_ptr<OccupancyModel> QueryCache::makeOccupancy(std::size_t level) const {
    const bool isBase = level == 0;
    const OccupancyModel::Surfaces surfaces = this->surfaces(level);
    const Mixture<4>& free = isBase ? model_.freeSpace.mixture() : freeMixture(level);
    const Coverage& coverage = isBase ? model_.coverage : this->coverage(level);
    auto made = std::make_unique<OccupancyModel>(model_.params.occupancy, surfaces,
                                                 coverage, model_.openings);
    for (std::uint32_t i = 0; i < surfaces.rows.size(); ++i) made->updateSurface(i);
    for (std::uint32_t i = 0; i < free.size(); ++i) made->updateFree(i, free[i]);
    return made;
}

void QueryCache::apply(const Changes& changes,
                       const std::vector<std::uint32_t>& updatedFree) {
    const ComponentStore& store = model_.components;
    logTotalSupport_.reset();
    blocks_.apply(changes);
    if (Indices* indices = indices_.value()) {
        indices->truncate(changes.size);
        for (const std::uint32_t i : changes.updated) indices->update(store.surfaces(), i);
    }
    auto* levels = levels_.value();
    if (levels == nullptr) return;
    // Made anew in a few milliseconds where they are asked for.
    levels->front()->patches2D.reset();
    levels->front()->patches3D.reset();
    if (OccupancyModel* base = levels->front()->occupancy.value()) {
        base->truncateSurfaces(changes.size);
        for (const std::uint32_t i : changes.updated) base->updateSurface(i);
        for (const std::uint32_t i : updatedFree)
            base->updateFree(i, model_.freeSpace.mixture()[i]);
    }
    for (std::size_t level = 1; level < levels->size(); ++level)
        levels->at(level) = std::make_unique<Level>();
}

void QueryCache::clear() {
    indices_.reset();
    logTotalSupport_.reset();
    levels_.reset();
    blocks_ = LevelBlocks();
}

std::size_t QueryCache::liveBytes() const {
    const std::lock_guard<std::mutex> lock(levelsMutex_);
    std::size_t bytes = blocks_.liveBytes();
    if (indices_.ready() != nullptr)
        bytes += indices_.ready()->components.liveBytes() +
                 indices_.ready()->grid.liveBytes() + indices_.ready()->pyramid.liveBytes();
    if (levels_.ready() == nullptr) return bytes;
    for (const auto& level : *levels_.ready()) bytes += level->liveBytes();
    return bytes;
}

}  // namespace hgmm
