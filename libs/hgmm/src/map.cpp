#include "hgmm/map.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "hgmm/level_blocks.h"
#include "hgmm/update.h"

namespace hgmm {

/// What is computed from the base. A copied or loaded map starts without it; the first
/// reader, const and possibly one of several threads, builds it.
class Map::Derived {
 public:
    const ComponentIndex& index(const Mixture<3>& base) {
        prepare(base);
        return index_;
    }

    double logTotalSupport(const Mixture<3>& base) {
        prepare(base);
        return logTotal_;
    }

    const Mixture<3>& level(const Mixture<3>& base, const HierarchyParams& params,
                            std::size_t level) {
        prepare(base);
        const std::lock_guard<std::mutex> lock(mutex_);
        return blocks_.levels(base, params)[level - 1];
    }

    /// Follows changes of components, and additions, which come last. Not for concurrent
    /// use.
    void update(const Mixture<3>& base, const std::vector<std::uint32_t>& changed) {
        for (const std::uint32_t i : changed) update(base, i);
        while (index_.size() < base.size())
            update(base, static_cast<std::uint32_t>(index_.size()));
        logTotal_ = std::log(base.totalSupport());
    }

    std::size_t liveBytes() const { return index_.liveBytes() + blocks_.liveBytes(); }

 private:
    void prepare(const Mixture<3>& base) {
        if (ready_.load(std::memory_order_acquire)) return;
        const std::lock_guard<std::mutex> lock(mutex_);
        if (ready_.load(std::memory_order_relaxed)) return;
        update(base, std::vector<std::uint32_t>());
        ready_.store(true, std::memory_order_release);
    }

    void update(const Mixture<3>& base, std::uint32_t i) {
        index_.update(base, i);
        blocks_.update(i);
    }

    std::atomic<bool> ready_{false};
    std::mutex mutex_;
    ComponentIndex index_;
    LevelBlocks blocks_;
    double logTotal_ = 0;
};

namespace {

/// Local frames start on a lattice of whole metres, so that poses relative to it are exact.
Eigen::Vector3d latticePoint(const Eigen::Vector3d& p) {
    return p.array().round();
}

/// EM from an overestimate, then Algorithm 1 down to the fidelity threshold.
Mixture<3> novelComponents(const Mixture<3>& samples, const Eigen::Vector3d& sensorOrigin,
                           const MapParams& params) {
    const InitialMixture initial = initialiseFromCells(samples, sensorOrigin, params.cells);
    const Mixture<3> reference =
        fitSparse(samples, initial.mixture, initial.neighbourhoods, params.em).mixture;
    return generateHierarchy(reference, params.hierarchy).levels.front();
}

}  // namespace

void MapParams::validate() const {
    filter.validate();
    novelty.validate();
    cells.validate();
    em.validate();
    hierarchy.validate();
}

Map::Map(const MapParams& params) : derived_(std::make_unique<Derived>()) {
    setParams(params);
}
Map::Map(const Map& o)
    : params_(o.params_),
      origin_(o.origin_),
      base_(o.base_),
      derived_(std::make_unique<Derived>()) {}
Map::Map(Map&& o) noexcept = default;
Map& Map::operator=(const Map& o) {
    if (this != &o) *this = Map(o);
    return *this;
}
Map& Map::operator=(Map&& o) noexcept = default;
Map::~Map() = default;

void Map::setParams(const MapParams& params) {
    params.validate();
    params_ = params;
    derived_ = std::make_unique<Derived>();
}

void Map::clear() {
    *this = Map(params_);
}

InsertReport Map::insert(const Scan& scan) {
    scan.validate();
    InsertReport report;
    const Mixture<3> samples_sensor = filterScan(scan, params_.filter, &report.points);
    report.samples = samples_sensor.size();
    if (samples_sensor.empty()) return report;

    if (empty()) origin_ = latticePoint(scan.T_map_sensor.t);
    const Pose T_local_sensor{scan.T_map_sensor.R, scan.T_map_sensor.t - origin_};
    const Mixture<3> samples = transformed(samples_sensor, T_local_sensor);

    const ComponentIndex& index = derived_->index(base_);
    const NoveltySplit split = splitByNovelty(samples, index, params_.novelty);
    const std::vector<std::uint32_t> changed = updateKnown(base_, index, samples, split);

    const std::size_t before = base_.size();
    if (!split.novel.empty())
        base_.append(
            novelComponents(selected(samples, split.novel), T_local_sensor.t, params_));
    derived_->update(base_, changed);

    report.novelSamples = split.novel.size();
    report.componentsUpdated = changed.size();
    report.componentsAdded = base_.size() - before;
    return report;
}

const Mixture<3>& Map::mixture(std::size_t level) const {
    if (level >= levelCount())
        throw std::out_of_range("Map: no level " + std::to_string(level) + ", only 0 to " +
                                std::to_string(levelCount() - 1));
    return level == 0 ? base_ : derived_->level(base_, params_.hierarchy, level);
}

double Map::logDensity(const Eigen::Vector3d& point_map) const {
    if (empty()) return -std::numeric_limits<double>::infinity();
    const ComponentIndex& index = derived_->index(base_);
    const Eigen::Vector3f p = (point_map - origin_).cast<float>();
    double density = -std::numeric_limits<double>::infinity();
    index.visitCandidates(p.x(), p.y(), p.z(), [&](std::uint32_t j) {
        density = logAddExp(density, std::log(double(base_.support[j])) +
                                         double(index.factor(j).logPdf(p.data())));
    });
    return density - derived_->logTotalSupport(base_);
}

std::size_t Map::liveBytes() const {
    const std::size_t perComponent = sizeof(float) * (1 + 3 + Mixture<3>::packed);
    return sizeof(Map) + sizeof(Derived) + base_.support.capacity() * perComponent +
           derived_->liveBytes();
}

bool Map::operator==(const Map& o) const {
    bool sameParams = true;
    std::vector<double> mine;
    forEachField(params_, [&](const char*, const auto& v) { mine.push_back(double(v)); });
    std::size_t k = 0;
    forEachField(o.params_,
                 [&](const char*, const auto& v) { sameParams &= mine[k++] == double(v); });
    return sameParams && origin_ == o.origin_ && base_ == o.base_;
}

}  // namespace hgmm
