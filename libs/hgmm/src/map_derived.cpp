#include "map_derived.h"

#include <cmath>

#include "storable.h"

namespace hgmm {

namespace {

std::unique_ptr<OccupancyModel> makeOccupancy(const Mixture<3>& surfaces,
                                              const Views& views, const Mixture<4>& free,
                                              const OccupancyParams& params) {
    auto model = std::make_unique<OccupancyModel>(params);
    for (std::uint32_t i = 0; i < surfaces.size(); ++i)
        model->updateSurface(i, surfaces[i], views[i]);
    for (std::uint32_t i = 0; i < free.size(); ++i) model->updateFree(i, free[i]);
    return model;
}

/// Views of a level: those of the base components that went into each of its components.
Views viewsOfLevel(const Mixture<3>& base, const Views& views,
                   const std::vector<std::uint32_t>& heirs, std::size_t size) {
    std::vector<View> sums(size);
    std::vector<double> supports(size, 0.0);
    for (std::size_t i = 0; i < base.size(); ++i) {
        const std::uint32_t heir = heirs[i];
        sums[heir] = supports[heir] > 0
                         ? merged(sums[heir], supports[heir], views[i], base.support[i])
                         : views[i];
        supports[heir] += base.support[i];
    }
    Views level;
    for (const View& view : sums) level.pushBack(view);
    return level;
}

Mixture<4> freeOfLevel(const Mixture<4>& free, const std::vector<std::uint32_t>& heirs,
                       std::size_t size) {
    std::vector<Gaussian<4>> sums(size);
    for (std::size_t i = 0; i < free.size(); ++i) {
        Gaussian<4>& sum = sums[heirs[i]];
        sum = sum.support > 0 ? mergeMoments(sum, free[i]) : free[i];
    }
    Mixture<4> level;
    for (const Gaussian<4>& g : sums) level.pushBack(storable(g));
    return level;
}

}  // namespace

void Map::Derived::Level::clear() {
    ready.store(nullptr, std::memory_order_release);
    occupancy.reset();
    hasFeatures = false;
}

void Map::Derived::prepare(const Map& map) {
    if (ready_.load(std::memory_order_acquire)) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ready_.load(std::memory_order_relaxed)) return;
    index_.reserve(map.model_.surfaces.size());
    clearance_.reserve(map.model_.surfaces.size());
    for (std::uint32_t i = 0; i < map.model_.surfaces.size(); ++i) enterSurface(map, i);
    logTotal_ = std::log(map.model_.surfaces.totalSupport());
    levelCount_ = map.levelCount();
    levels_ = std::make_unique<Level[]>(levelCount_);
    ready_.store(true, std::memory_order_release);
}

void Map::Derived::enterSurface(const Map& map, std::uint32_t i) {
    const Mixture<3>& base = map.model_.surfaces;
    index_.update(base, i);
    const Eigen::Vector3d mean(base.mean[0][i], base.mean[1][i], base.mean[2][i]);
    grid_.update(i, mean);
    clearance_.update(i, mean);
    blocks_.update(i);
}

const ComponentIndex& Map::Derived::index(const Map& map) {
    prepare(map);
    return index_;
}

const CoarseGrid& Map::Derived::grid(const Map& map) {
    prepare(map);
    return grid_;
}

const Clearance& Map::Derived::clearance(const Map& map) {
    prepare(map);
    return clearance_;
}

double Map::Derived::logTotalSupport(const Map& map) {
    prepare(map);
    return logTotal_;
}

const Mixture<3>& Map::Derived::mixture(const Map& map, std::size_t level) {
    prepare(map);
    const std::lock_guard<std::mutex> lock(mutex_);
    return blocks_.levels(map.model_.surfaces, map.params_.hierarchy)[level - 1];
}

/// Under the lock.
Map::Derived::Level& Map::Derived::upperLevel(const Map& map, std::size_t level) {
    Level& features = levels_[level];
    if (features.hasFeatures) return features;
    const Model& model = map.model_;
    const std::size_t size =
        blocks_.levels(model.surfaces, map.params_.hierarchy)[level - 1].size();
    const std::vector<std::uint32_t>& heirs = blocks_.heirs(level);
    features.views = viewsOfLevel(model.surfaces, model.views, heirs, size);
    features.free = map.freePerComponent()
                        ? freeOfLevel(model.freeOfSurfaces, heirs, size)
                        : model.freeSpace.coarsened(static_cast<int>(level));
    features.hasFeatures = true;
    return features;
}

const Views& Map::Derived::views(const Map& map, std::size_t level) {
    prepare(map);
    const std::lock_guard<std::mutex> lock(mutex_);
    return upperLevel(map, level).views;
}

const Mixture<4>& Map::Derived::freeMixture(const Map& map, std::size_t level) {
    prepare(map);
    const std::lock_guard<std::mutex> lock(mutex_);
    return upperLevel(map, level).free;
}

const OccupancyModel& Map::Derived::occupancy(const Map& map, std::size_t level) {
    prepare(map);
    std::atomic<const OccupancyModel*>& ready = levels_[level].ready;
    // Single queries come by the million: no lock for them.
    if (const OccupancyModel* model = ready.load(std::memory_order_acquire)) return *model;
    const std::lock_guard<std::mutex> lock(mutex_);
    std::unique_ptr<OccupancyModel>& occupancy = levels_[level].occupancy;
    if (occupancy) return *occupancy;
    const OccupancyParams& params = map.params_.occupancy;
    if (level == 0) {
        occupancy =
            makeOccupancy(map.model_.surfaces, map.model_.views, map.freeMixture(), params);
    } else {
        const Level& features = upperLevel(map, level);
        const Mixture<3>& surfaces =
            blocks_.levels(map.model_.surfaces, map.params_.hierarchy)[level - 1];
        occupancy = makeOccupancy(surfaces, features.views, features.free, params);
    }
    ready.store(occupancy.get(), std::memory_order_release);
    return *occupancy;
}

void Map::Derived::updateSurface(const Map& map, std::uint32_t i) {
    enterSurface(map, i);
    OccupancyModel* occupancy = levels_[0].occupancy.get();
    if (occupancy != nullptr)
        occupancy->updateSurface(i, map.model_.surfaces[i], map.model_.views[i]);
}

void Map::Derived::removeSurface(std::uint32_t i) {
    index_.removeSwap(i);
    grid_.removeSwap(i);
    clearance_.removeSwap(i);
    blocks_.removeSwap(i);
    if (levels_[0].occupancy) levels_[0].occupancy->removeSurface(i);
}

void Map::Derived::updateFree(const Map& map, std::uint32_t i) {
    if (levels_[0].occupancy) levels_[0].occupancy->updateFree(i, map.freeMixture()[i]);
}

void Map::Derived::removeFree(std::uint32_t i) {
    if (levels_[0].occupancy) levels_[0].occupancy->removeFree(i);
}

void Map::Derived::finish(const Map& map) {
    logTotal_ = std::log(map.model_.surfaces.totalSupport());
    for (std::size_t level = 1; level < levelCount_; ++level) levels_[level].clear();
}

std::size_t Map::Derived::liveBytes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::size_t bytes = index_.liveBytes() + grid_.liveBytes() + clearance_.liveBytes() +
                        blocks_.liveBytes();
    for (std::size_t l = 0; l < levelCount_; ++l) {
        const Level& level = levels_[l];
        if (level.occupancy) bytes += level.occupancy->liveBytes();
        bytes += level.views.size() * 4 * sizeof(float) +
                 level.free.size() * sizeof(float) * (1 + 4 + Mixture<4>::packed);
    }
    return bytes;
}

}  // namespace hgmm
