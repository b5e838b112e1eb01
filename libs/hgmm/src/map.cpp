#include "hgmm/map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "hgmm/update.h"
#include "map_derived.h"
#include "require_rigid.h"
#include "run_both.h"
#include "storable.h"

namespace hgmm {

namespace {

/// Local frames start on a lattice of whole metres, so that poses relative to it are exact.
Eigen::Vector3d latticePoint(const Eigen::Vector3d& p) {
    return p.array().round();
}

/// Of the novel samples, those that outgrown components could not explain.
std::vector<std::uint32_t> learntAgain(const NoveltySplit& split) {
    std::vector<std::uint32_t> again;
    auto outgrown = split.outgrown.begin();
    for (std::uint32_t n = 0; n < split.novel.size(); ++n) {
        while (outgrown != split.outgrown.end() && outgrown->sample < split.novel[n])
            ++outgrown;
        if (outgrown == split.outgrown.end()) break;
        if (outgrown->sample == split.novel[n]) again.push_back(n);
    }
    return again;
}

/// EM from an overestimate, then Algorithm 1 down to the fidelity threshold.
Mixture<3> novelComponents(const Mixture<3>& samples, const NoveltySplit& split,
                           const ThicknessLimit& limit, const MapParams& params) {
    const Mixture<3> novel = selected(samples, split.novel);
    const Thinning thinning{limit, learntAgain(split), params.contradiction.minSupport};
    const InitialMixture initial =
        initialiseFromCells(novel, limit.sensorOrigin, params.cells, &thinning);
    const Mixture<3> reference =
        fitSparse(novel, initial.mixture, initial.neighbourhoods, params.em).mixture;
    HierarchyParams toThreshold = params.hierarchy;
    toThreshold.levels = 1;
    return generateHierarchy(reference, toThreshold).levels.front();
}

}  // namespace

void MapParams::validate() const {
    filter.validate();
    novelty.validate();
    cells.validate();
    em.validate();
    hierarchy.validate();
    occupancy.validate();
    contradiction.validate();
    modality.validate();
    if (modalities.size() > kMaxModalities)
        throw std::invalid_argument("modalities: " + std::to_string(modalities.size()) +
                                    " names, at most " + std::to_string(kMaxModalities));
    for (auto name = modalities.begin(); name != modalities.end(); ++name) {
        if (name->empty() || name->size() > 255)
            throw std::invalid_argument("modalities: names must have 1 to 255 characters");
        // Configuration files separate names by commas and begin comments with the others.
        if (name->find_first_of(",;#/\n\r") != std::string::npos || name->front() == ' ' ||
            name->back() == ' ')
            throw std::invalid_argument("modalities: '" + *name +
                                        "' must hold none of , ; # / and no outer blanks");
        if (std::find(modalities.begin(), name, *name) != name)
            throw std::invalid_argument("modalities: '" + *name + "' is named twice");
    }
}

Map::Map(const MapParams& params) : derived_(std::make_unique<Derived>()) {
    setParams(params);
}
Map::Map(const Map& o)
    : params_(o.params_),
      origin_(o.origin_),
      model_(o.model_),
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
    if (!empty() && params.occupancy.freeSpace.freeSpaceModel !=
                        params_.occupancy.freeSpace.freeSpaceModel)
        throw std::invalid_argument(
            "freeSpaceModel: a map that holds components keeps the model it was built "
            "with");
    params_ = params;
    model_.modalities.configure(params_);
    derived_ = std::make_unique<Derived>();
}

bool Map::freePerComponent() const {
    return params_.occupancy.freeSpace.freeSpaceModel ==
           static_cast<int>(FreeSpaceModel::perComponent);
}

bool Map::isBlank() const {
    return empty() && model_.modalities.groups().empty();
}

void Map::clear() {
    *this = Map(params_);
}

Eigen::Vector3d Map::originWith(const Pose& T_map_sensor) const {
    return isBlank() ? latticePoint(T_map_sensor.t) : origin_;
}

InsertReport Map::insert(const Scan& scan) {
    scan.validate();
    if (params_.modalities.empty() || scan.channels.empty())
        return insert(samplesOf(scan, params_), scan.T_map_sensor);
    InsertReport report;
    const Eigen::Vector3d origin = originWith(scan.T_map_sensor);
    const Pose T_local_sensor{scan.T_map_sensor.R, scan.T_map_sensor.t - origin};
    runBoth([&] { insertSpace(samplesOf(scan, params_), T_local_sensor, report); },
            [&] { model_.modalities.insert(scan, T_local_sensor, params_); });
    if (report.samples > 0) origin_ = origin;
    return report;
}

InsertReport Map::insert(const ScanSamples& scan, const Pose& T_map_sensor) {
    requireRigid(T_map_sensor, "T_map_sensor");
    InsertReport report;
    const Eigen::Vector3d origin = originWith(T_map_sensor);
    insertSpace(scan, {T_map_sensor.R, T_map_sensor.t - origin}, report);
    if (report.samples > 0) origin_ = origin;
    return report;
}

void Map::insertSpace(const ScanSamples& scan, const Pose& T_local_sensor,
                      InsertReport& report) {
    report.points = scan.points;
    report.samples = scan.samples_sensor.size();
    if (scan.samples_sensor.empty()) return;
    const Mixture<3> samples = transformed(scan.samples_sensor, T_local_sensor);
    const ThicknessLimit limit{params_.novelty.maxThickness, params_.cells, params_.filter,
                               T_local_sensor.t,
                               T_local_sensor.R * scan.normalOfRays_sensor};
    std::vector<std::uint32_t> weakened;
    const std::vector<RayBundle> bundles = insertSurfaces(samples, limit, weakened, report);
    if (!freePerComponent())
        for (const std::uint32_t i :
             model_.freeSpace.insert(bundles, T_local_sensor.t, derived_->clearance(*this),
                                     params_.occupancy.band, params_.occupancy.freeSpace))
            derived_->updateFree(*this, i);
    contradict(samples, T_local_sensor.t, weakened, report);
    removeWeak(std::move(weakened), report);
    derived_->finish(*this);
}

std::vector<RayBundle> Map::insertSurfaces(const Mixture<3>& samples,
                                           const ThicknessLimit& limit,
                                           std::vector<std::uint32_t>& weakened,
                                           InsertReport& report) {
    Mixture<3>& surfaces = model_.surfaces;
    const Eigen::Vector3d& sensorOrigin = limit.sensorOrigin;
    const ComponentIndex& index = derived_->index(*this);
    const Sighting sighting{model_.views, limit};
    const NoveltySplit split = splitByNovelty(samples, index, params_.novelty, &sighting);
    KnownUpdate known = updateKnown(surfaces, index, samples, split);
    std::vector<RayBundle> bundles = std::move(known.shares);
    for (std::size_t k = 0; k < known.changed.size(); ++k) {
        const std::uint32_t i = known.changed[k];
        const double before = surfaces.support[i] - bundles[k].support;
        model_.views.set(
            i, merged(model_.views[i], std::max(before, 1e-6),
                      viewFrom(sensorOrigin, bundles[k].mean), bundles[k].support));
        // Before it gives way: what it loses, it loses of both.
        if (freePerComponent()) addFreeOfSurface(i, bundles[k], sensorOrigin);
    }
    for (const Loss& loss : giveWay(surfaces, index, samples, split)) {
        // Its free space is that of the same hits.
        if (freePerComponent()) {
            Mixture<4>& free = model_.freeOfSurfaces;
            free.support[loss.component] *= static_cast<float>(loss.kept);
            derived_->updateFree(*this, loss.component);
        }
        derived_->updateSurface(*this, loss.component);
        weakened.push_back(loss.component);
    }
    report.componentsOutgrown = weakened.size();
    const std::size_t before = surfaces.size();
    if (!split.novel.empty()) {
        const Mixture<3> novel = novelComponents(samples, split, limit, params_);
        // EM leaves components that hardly explain anything; they would still answer.
        for (std::size_t i = 0; i < novel.size(); ++i)
            if (novel.support[i] >= params_.contradiction.minSupport)
                surfaces.pushBack(novel[i]);
    }
    for (std::size_t i = before; i < surfaces.size(); ++i) {
        bundles.push_back(surfaces[i]);
        model_.views.pushBack(viewFrom(sensorOrigin, bundles.back().mean));
        known.changed.push_back(static_cast<std::uint32_t>(i));
        if (freePerComponent())
            addFreeOfSurface(known.changed.back(), bundles.back(), sensorOrigin);
    }
    for (const std::uint32_t i : known.changed) derived_->updateSurface(*this, i);
    report.novelSamples = split.novel.size();
    report.componentsAdded = surfaces.size() - before;
    report.componentsUpdated = known.changed.size() - report.componentsAdded;
    return bundles;
}

void Map::addFreeOfSurface(std::uint32_t i, const RayBundle& bundle,
                           const Eigen::Vector3d& sensorOrigin) {
    const double range = (sensorOrigin - bundle.mean).norm();
    const Gaussian<4> slab = freeSlab(bundle, sensorOrigin, 0.0, range);
    Mixture<4>& free = model_.freeOfSurfaces;
    if (i == free.size())
        free.pushBack(storable(slab));
    else
        free.set(i, storable(mergeMoments(free[i], slab)));
    derived_->updateFree(*this, i);
}

void Map::contradict(const Mixture<3>& samples, const Eigen::Vector3d& sensorOrigin,
                     std::vector<std::uint32_t>& weakened, InsertReport& report) {
    const ContradictionParams& params = params_.contradiction;
    if (params.contradictedKeep == 1.0) return;
    const RangeImage image(samples, sensorOrigin);
    Eigen::Vector3d low = sensorOrigin, high = sensorOrigin;
    for (int d = 0; d < 3; ++d) {
        const auto [least, most] =
            std::minmax_element(samples.mean[d].begin(), samples.mean[d].end());
        low[d] = std::min<double>(low[d], *least);
        high[d] = std::max<double>(high[d], *most);
    }
    for (const std::uint32_t i : derived_->grid(*this).within(low, high)) {
        Gaussian<3> g = model_.surfaces[i];
        if (!isSeenThrough(g, image, sensorOrigin)) continue;
        ++report.componentsContradicted;
        g.support *= params.contradictedKeep;
        model_.surfaces.set(i, g);
        derived_->updateSurface(*this, i);
        weakened.push_back(i);
    }
}

void Map::removeWeak(std::vector<std::uint32_t> weakened, InsertReport& report) {
    // From the last on, so that the one that takes a removed one's place stays.
    std::sort(weakened.rbegin(), weakened.rend());
    weakened.erase(std::unique(weakened.begin(), weakened.end()), weakened.end());
    for (const std::uint32_t i : weakened) {
        const float support = model_.surfaces.support[i];
        if (support > kNoSupport && support >= params_.contradiction.minSupport) continue;
        removeSurface(i);
        ++report.componentsRemoved;
    }
}

void Map::removeSurface(std::uint32_t i) {
    model_.surfaces.removeSwap(i);
    model_.views.removeSwap(i);
    derived_->removeSurface(i);
    if (!freePerComponent()) return;
    model_.freeOfSurfaces.removeSwap(i);
    derived_->removeFree(i);
}

std::size_t Map::liveBytes() const {
    const std::size_t perSurface = sizeof(float) * (1 + 3 + Mixture<3>::packed + 4);
    return sizeof(Map) + sizeof(Derived) + model_.surfaces.support.capacity() * perSurface +
           model_.freeOfSurfaces.size() * sizeof(float) * (1 + 4 + Mixture<4>::packed) +
           model_.freeSpace.liveBytes() + model_.modalities.liveBytes() +
           derived_->liveBytes();
}

bool Map::Model::operator==(const Model& o) const {
    return surfaces == o.surfaces && views == o.views && freeSpace == o.freeSpace &&
           freeOfSurfaces == o.freeOfSurfaces && modalities == o.modalities;
}

bool Map::operator==(const Map& o) const {
    bool sameParams = true;
    std::vector<double> mine;
    forEachField(params_, [&](const char*, const auto& v) { mine.push_back(double(v)); });
    std::size_t k = 0;
    forEachField(o.params_,
                 [&](const char*, const auto& v) { sameParams &= mine[k++] == double(v); });
    sameParams &= params_.modalities == o.params_.modalities;
    return sameParams && origin_ == o.origin_ && model_ == o.model_;
}

}  // namespace hgmm
