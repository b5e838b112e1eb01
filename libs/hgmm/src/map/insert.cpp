#include <algorithm>
#include <cmath>
#include <vector>

#include "base/portable_math.h"
#include "base/require_rigid.h"
#include "base/run_both.h"
#include "fusion/carving.h"
#include "fusion/missed.h"
#include "fusion/novelty.h"
#include "fusion/oversized.h"
#include "fusion/update.h"
#include "hgmm/em.h"
#include "hgmm/hierarchy.h"
#include "hgmm/map.h"
#include "map/model.h"
#include "occupancy/mark_rays.h"
#include "occupancy/passed_surfaces.h"
#include "scan/cells.h"

namespace hgmm {

namespace {

/// Hits of a surface beyond this many do not count against rays that pass through it, so
/// that what stood long goes as soon as what stood briefly.
constexpr float kTrustedHits = 40.F;

/// A component that is missed (fusion/missed.h) so often loses what it would lose if it
/// were seen through once [scans].
constexpr double kMissesPerCarving = 60.0;

/// Local frames start on a lattice of whole metres, so that poses relative to it are exact.
Eigen::Vector3d latticePoint(const Eigen::Vector3d& p) {
    return p.array().round();
}

/// Where the local frame begins, or would with a scan from there.
Eigen::Vector3d originWith(const Model& model, const Pose& T_map_sensor) {
    return model.isBlank() ? latticePoint(T_map_sensor.t) : model.origin;
}

/// Adds known samples to the components that explain them. Returns what each was given.
std::vector<RayBundle> updateComponents(ComponentStore& store, KnownUpdate update,
                                        const Eigen::Vector3d& sensorOrigin) {
    for (std::size_t k = 0; k < update.changed.size(); ++k) {
        const std::uint32_t i = update.changed[k];
        const RayBundle& share = update.shares[k];
        const double after = static_cast<float>(update.components[k].support);
        const ViewDirection view =
            merged(store.viewDirections()[i], std::max(after - share.support, 1e-6),
                   viewFrom(sensorOrigin, share.mean), share.support);
        store.set(i, update.components[k], view);
    }
    return std::move(update.shares);
}

/// EM from an overestimate, then Algorithm 1 down to the fidelity threshold.
Mixture<3> fitNovel(const Mixture<3>& samples, const NoveltySplit& split,
                    const ThicknessLimit& limit, const MapParams& params) {
    const Mixture<3> novel = selected(samples, split.novel);
    CellMoments guess = momentsOfCells(novel, limit.sensorOrigin, params.cells);
    splitOversized(novel, {limit, relearned(split), params.carving.minSupport}, guess);
    const InitialMixture initial = initialMixture(novel, guess);
    const Mixture<3> reference =
        fitSparse(novel, initial.mixture, initial.neighbourhoods, params.em).mixture;
    HierarchyParams toThreshold = params.hierarchy;
    toThreshold.levels = 1;
    return generateHierarchy(reference, toThreshold).levels.front();
}

/// Appends components of at least `minSupport`: EM leaves some that hardly explain anything
/// and would still answer. Returns their hits.
std::vector<RayBundle> addComponents(ComponentStore& store, const Mixture<3>& novel,
                                     const Eigen::Vector3d& sensorOrigin,
                                     double minSupport) {
    std::vector<RayBundle> bundles;
    for (std::size_t i = 0; i < novel.size(); ++i) {
        if (!(novel.support[i] >= minSupport)) continue;
        bundles.push_back(novel[i]);
        store.add(bundles.back(), viewFrom(sensorOrigin, bundles.back().mean));
    }
    return bundles;
}

/// Where all rays of a scan end, those that clear included, in the local frame.
Mixture<3> endsOfRays(const Mixture<3>& samples, const ScanSamples& scan,
                      const Pose& T_local_sensor) {
    Mixture<3> ends = samples;
    for (const ClearedRay& ray : scan.clearedRays_sensor) {
        Gaussian<3> end;
        end.support = 1.0;
        end.mean = T_local_sensor.t +
                   T_local_sensor.R * (double(ray.length_m) * ray.direction.cast<double>());
        end.covariance.setIdentity();
        ends.pushBack(end);
    }
    return ends;
}

/// Removes those of `weakened` that are left with too little support. Returns how many.
std::size_t removeWeak(ComponentStore& store, std::vector<std::uint32_t> weakened,
                       double minSupport) {
    // Falling, for remove() puts the last row into the place of the removed one.
    std::sort(weakened.rbegin(), weakened.rend());
    weakened.erase(std::unique(weakened.begin(), weakened.end()), weakened.end());
    std::size_t removed = 0;
    for (const std::uint32_t i : weakened) {
        const float support = store.surfaces().support[i];
        if (support > kNoSupport && support >= minSupport) continue;
        store.remove(i);
        ++removed;
    }
    return removed;
}

/// Components that rays may have met, or that lie as far behind their ends as a surface
/// may be thick, rising.
std::vector<std::uint32_t> inViewOf(const Mixture<3>& ends, const ScanRays& rays,
                                    const CoarseGrid& grid) {
    const double around_m = std::sqrt(rays.limit.maxVarianceAt(rays.image.longest_m()));
    Eigen::Vector3d low = rays.image.origin(), high = low;
    for (int d = 0; d < 3; ++d) {
        const auto [least, most] =
            std::minmax_element(ends.mean[d].begin(), ends.mean[d].end());
        low[d] = std::min<double>(low[d], *least) - around_m;
        high[d] = std::max<double>(high[d], *most) + around_m;
    }
    return grid.within(low, high);
}

/// Multiplies supports, of which `trusted` hits count at most.
void weaken(ComponentStore& store, const std::vector<std::uint32_t>& rows, double kept,
            float trusted, std::vector<std::uint32_t>& weakened) {
    for (const std::uint32_t i : rows) {
        const double counted = std::min(store.surfaces().support[i], trusted);
        store.setSupport(i, static_cast<float>(counted * kept));
    }
    weakened.insert(weakened.end(), rows.begin(), rows.end());
}

/// What rays take from surfaces that they missed or passed.
/// @param hit rows that the scan gave support to, rising
void carve(const Mixture<3>& samples, const ScanSamples& scan, const Pose& T_local_sensor,
           const ThicknessLimit& limit, const std::vector<std::uint32_t>& hit, Model& model,
           const QueryCache& cache, std::vector<std::uint32_t>& weakened,
           InsertReport& report) {
    const double carved = model.params.carving.carvedSupport;
    if (carved == 1.0) return;
    ComponentStore& store = model.components;
    const Mixture<3> ends = endsOfRays(samples, scan, T_local_sensor);
    const RayImage image(ends, T_local_sensor.t);
    const ScanRays rays{image, limit, scan.raySpacing_rad};
    const std::vector<std::uint32_t> near = inViewOf(ends, rays, cache.grid());

    const std::vector<std::uint32_t> missedRows =
        missed(store.surfaces(), hit, kTrustedHits, rays, cache.index(), near);
    weaken(store, missedRows, portable::exp(portable::log(carved) / kMissesPerCarving),
           kTrustedHits, weakened);
    const Coverage::Rays cells(model.params.occupancy.coverage, scan.raySpacing_rad,
                               limit.normalOfRays);
    model.openings.learn(
        passedSurfaces(store.surfaces(), cache.index(), near, kTrustedHits, image, cells),
        samples, T_local_sensor.t, cells);
    const std::vector<std::uint32_t> seen =
        seenThrough(store.surfaces(), image, limit.normalOfRays, near);
    weaken(store, seen, carved, kTrustedHits, weakened);
    report.componentsMissed = missedRows.size();
    report.componentsCarved = seen.size();
}

/// What a scan did to the surfaces.
struct Learned {
    std::vector<RayBundle> bundles;        ///< its hits, by component
    std::vector<std::uint32_t> hit;        ///< rows that it gave support to, rising
    std::vector<std::uint32_t> oversized;  ///< rows that lost support
};

/// Thesis 3.3.3 to 3.3.5: known samples update components, novel ones become new ones.
Learned learnSurfaces(const Mixture<3>& samples, const NoveltySplit& split,
                      const ThicknessLimit& limit, const MapParams& params,
                      ComponentStore& store, const ComponentIndex& index) {
    Learned learned;
    KnownUpdate update = updateKnown(store.surfaces(), index, samples, split);
    learned.hit = update.changed;
    learned.bundles = updateComponents(store, std::move(update), limit.sensorOrigin);
    for (const SupportDecay& decay :
         downweightOversized(store.surfaces(), index, samples, split)) {
        store.setSupport(decay.component, decay.support);
        learned.oversized.push_back(decay.component);
    }
    if (split.novel.empty()) return learned;
    const std::size_t before = store.size();
    const std::vector<RayBundle> added =
        addComponents(store, fitNovel(samples, split, limit, params), limit.sensorOrigin,
                      params.carving.minSupport);
    learned.bundles.insert(learned.bundles.end(), added.begin(), added.end());
    for (std::size_t i = before; i < store.size(); ++i)
        learned.hit.push_back(static_cast<std::uint32_t>(i));
    return learned;
}

/// The method on one screen: thesis 3.3.3 to 4.2, and carving.
void insertSamples(const ScanSamples& scan, const Pose& T_local_sensor, Model& model,
                   QueryCache& cache, InsertReport& report) {
    const MapParams& params = model.params;
    ComponentStore& store = model.components;
    report.points = scan.points;
    report.samples = scan.samples_sensor.size();
    if (scan.samples_sensor.empty() && scan.clearedRays_sensor.empty()) return;
    const Eigen::Vector3d& sensorOrigin = T_local_sensor.t;
    const Mixture<3> samples = transformed(scan.samples_sensor, T_local_sensor);
    const ThicknessLimit limit{params.novelty.maxThickness, params.cells, params.filter,
                               sensorOrigin, T_local_sensor.R * scan.normalOfRays_sensor};

    const SensorGeometry geometry{store.viewDirections(), limit};
    const NoveltySplit split =
        splitByNovelty(samples, cache.index(), params.novelty, &geometry);
    report.novelSamples = split.novel.size();
    const std::size_t before = store.size();
    Learned learned;
    runBoth(
        [&] {
            learned = learnSurfaces(samples, split, limit, params, store, cache.index());
            cache.apply(store.takeChanges());
        },
        [&] {
            markRays(samples, scan, T_local_sensor, params.occupancy.coverage,
                     model.coverage);
        });
    report.componentsAdded = store.size() - before;
    report.componentsUpdated = learned.bundles.size() - report.componentsAdded;
    report.componentsOversized = learned.oversized.size();

    const std::vector<std::uint32_t> updatedFree =
        model.freeSpace.insert(learned.bundles, sensorOrigin, cache.pyramid(),
                               params.occupancy.band, params.occupancy.freeSpace);
    std::vector<std::uint32_t> weakened = std::move(learned.oversized);
    carve(samples, scan, T_local_sensor, limit, learned.hit, model, cache, weakened,
          report);
    report.componentsRemoved =
        removeWeak(store, std::move(weakened), params.carving.minSupport);
    cache.apply(store.takeChanges(), updatedFree);
}

}  // namespace

InsertReport Map::insert(const Scan& scan) {
    scan.validate();
    Model& model = state_->model;
    if (model.params.modalities.empty() || scan.channels.empty())
        return insert(samplesOf(scan, model.params), scan.T_map_sensor);
    InsertReport report;
    const Eigen::Vector3d origin = originWith(model, scan.T_map_sensor);
    const Pose T_local_sensor{scan.T_map_sensor.R, scan.T_map_sensor.t - origin};
    runBoth(
        [&] {
            insertSamples(samplesOf(scan, model.params), T_local_sensor, model,
                          state_->cache, report);
        },
        [&] { model.modalities.insert(scan, T_local_sensor, model.params); });
    if (!model.isBlank()) model.origin = origin;
    return report;
}

InsertReport Map::insert(const ScanSamples& scan, const Pose& T_map_sensor) {
    requireRigid(T_map_sensor, "T_map_sensor");
    InsertReport report;
    Model& model = state_->model;
    const Eigen::Vector3d origin = originWith(model, T_map_sensor);
    insertSamples(scan, {T_map_sensor.R, T_map_sensor.t - origin}, model, state_->cache,
                  report);
    if (!model.isBlank()) model.origin = origin;
    return report;
}

}  // namespace hgmm
