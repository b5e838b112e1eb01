#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/option.h"

namespace hgmm {

/// How a scan is reduced to samples, one for each occupied leaf (filterScan). Leaves grow
/// in octaves with the square root of the range: midway between the spacing of a sensor's
/// rays, which grows with the range, and the detail that a map is wanted for, which does
/// not.
struct FilterParams {
    /// Leaf edge at range 1 m [m], > 0. The map's other lengths have a ratio to it
    /// (MapParams::setResolution); assigning this field changes none of them.
    double resolution_m = 0.04;
    double minLeaf_m = 0.01;  ///< smallest leaf edge [m], > 0
    double minRange_m = 0.1;  ///< nearer points are dropped [m], >= 0
    /// Farther points are no surfaces; their rays clear space up to here [m],
    /// >= minRange_m.
    double maxRange_m = 300.0;
    double noiseStd_m = 0.003;     ///< range noise at range 0, one sigma [m], > 0
    double noisePerRange = 0.001;  ///< its growth with range [m/m], >= 0

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<FilterParams>& options();

    /// Standard deviation [m] of a measurement at `range_m`.
    double noiseAt(double range_m) const { return noiseStd_m + noisePerRange * range_m; }
};

/// Which samples the map explains already (thesis 3.3.3).
///
/// The thesis thresholds the log-likelihood of the weighted mixture at lambda_n = -10.5;
/// weights shrink as a map grows, so that threshold drifts. Here it is local: a sample is
/// known if it lies within `maxMahalanobis` of one component, whatever else the map holds.
///
/// What lies within some sigmas of a wide component would make it wider still, scan after
/// scan. In the thesis the low density of wide components prevents that; here a component
/// explains only samples at which it is thin beside the cells of a first guess.
struct NoveltyParams {
    double maxMahalanobis = 3.0;  ///< [sigma], in [0.1, 4]
    /// Standard deviation across the surface that a ray meets, besides that of the noise
    /// [cell edges at the ray's range, CellParams::edgeAt], in [0.001, 1000]. The default,
    /// 1 / sqrt(12), is that of hits all over a cell.
    double maxThickness = 0.29;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<NoveltyParams>& options();
};

/// The first guess of a mixture: moments of the samples in each cell of a voxel grid,
/// thesis 3.3.4 ("a voxel-grid filter ... indicative of the overestimate for lambda_f").
struct CellParams {
    /// Cell edge at range 1 m [m], > 0; grows with the square root of the range.
    double cellAtOneMetre_m = 0.22;
    double minCell_m = 0.04;  ///< smallest cell edge [m], > 0
    int minSamples = 5;  ///< a cell with fewer joins a cell twice its size [count], >= 1

    /// Cell edge at a range [m]; the lattice rounds it down to an octave.
    double edgeAt(double range_m) const {
        return std::max(minCell_m, cellAtOneMetre_m * std::sqrt(range_m));
    }

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<CellParams>& options();
};

/// Expectation-Maximization, thesis 3.1.2.
struct EmParams {
    int maxIterations = 5;  ///< E- and M-steps [count], >= 0
    double minImprovement =
        1e-3;  ///< stop when the log-likelihood gains less [nat/point], >= 0

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<EmParams>& options();
};

/// Algorithm 1 of the thesis (3.3.2).
struct HierarchyParams {
    static constexpr double kLargestSimilarity = 1e7;  ///< any two merge at it [nat]

    int levels = 5;  ///< L, levels kept from the fidelity threshold up [count], >= 1
    double similarityStart = 0.9;  ///< lambda_d of the first merge pass [nat], > 0
    double similarityStep = 0.2;   ///< added to lambda_d after each pass [nat], >= 0
    /// lambda_d that the fidelity threshold may not need more than [nat], > 0. Adjacent
    /// tiles of one plane differ by about 6 nat, the two sides of an edge by tens.
    double similarityMax = 5.0;
    double levelRatio =
        0.7;  ///< a map's level has at most so much of the one below [1], (0, 1)

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<HierarchyParams>& options();
};

/// How the distance variable W is distributed in front of a surface component (thesis 4.1):
/// a point is a hit (w = 0) with probability 1 - freeShare, else it lies w in front of the
/// surface, along the component's view direction. The density of w is even up to the width
/// of the band, so that hits and free points near a surface are weighed alike for every
/// component, and falls as 1/w from there to its reach, where the free-space mixture
/// begins.
struct FreeSpaceBandParams {
    /// Share of free points within the band's width [1], in (0, 1). At 0.5 the probability
    /// of a point within the band is that of a hit against an equally likely free point.
    double freeShare = 0.45;
    double bandBase_m = 0.5;          ///< width of the band at range 0 [m], > 0
    double bandPerRange = 0.015;      ///< its growth with range [m/m], >= 0
    double bandReachPerRange = 0.25;  ///< reach per range, at least the width [1], >= 0

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<FreeSpaceBandParams>& options();

    /// [m]
    double width(double range_m) const { return bandBase_m + bandPerRange * range_m; }
    /// [m]
    double reach(double range_m) const {
        return std::max(width(range_m), bandReachPerRange * range_m);
    }
    /// Free points per hit and metre of w within the width [1/m]. Beyond, times width / w.
    double freePerMetre(double range_m) const {
        return freeShare / ((1 - freeShare) * width(range_m));
    }
};

/// The free space that rays passed (thesis 4.2), as a mixture on a lattice.
struct FreeSpaceParams {
    /// Edge of the smallest cells where rays end at range 1 m [m], > 0; grows with the
    /// square root of the range, like those of surfaces (CellParams).
    double freeCellAtOneMetre_m = 1.6;
    /// A free component that holds this many times what a scan would add learns no more
    /// [scans], >= 1: so that something new in long-known free space is soon believed.
    double freeSettledScans = 8.0;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<FreeSpaceParams>& options();
};

/// Cells of the space that rays passed. Their edge grows in octaves with the square root
/// of the distance to the sensor, from half a metre on.
struct CoverageParams {
    /// Edge at a distance of 1 m [m], > 0: twice a leaf's (FilterParams), so that the
    /// samples of a scan leave no gaps.
    double coverageCellAtOneMetre_m = 0.08;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<CoverageParams>& options();

    /// Edge of cells at a distance w from the sensor, before it is rounded to an octave
    /// [m].
    double edgeAt(double w_m) const {
        return coverageCellAtOneMetre_m * std::sqrt(std::max(w_m, 0.5));
    }
};

/// How a point becomes occupied, free or unknown (thesis 4.3).
struct OccupancyParams {
    FreeSpaceBandParams band;
    FreeSpaceParams freeSpace;
    CoverageParams coverage;
    /// A point this far behind a single surface component is as likely unknown as known
    /// [sigma], in [1, 3.9].
    double knownSigmas = 3.0;
    /// The same for a point beside a surface component [sigma], in [1, knownSigmas].
    /// Components are tiles: evenly filled, one ends at sqrt(3) sigma of its extent, while
    /// across a surface they are as thick as the noise is.
    double extentSigmas = 2.4;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<OccupancyParams>& options();
};

/// What becomes of a surface that rays pass through.
struct CarvingParams {
    /// Share of its support, of which at most 40 hits count, that a component keeps each
    /// time a scan saw through it [1], in (0, 1]; 1 = rays never remove surfaces.
    double carvedSupport = 0.05;
    /// A component with less support is dropped, new ones included [count], >= 0.
    double minSupport = 0.5;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<CarvingParams>& options();
};

/// How modalities (thesis chapter 5) are learnt.
struct ModalityParams {
    /// Leaf edge at range 1 m [m], > 0, growing like FilterParams::resolution_m: finer
    /// than that of the surfaces, for texture is finer than shape.
    double modalityLeafAtOneMetre_m = 0.028;
    /// Share of the variance of a modality within a scan that its components need not
    /// explain, in (0, 1): 1 - R^2 of what the map keeps of a scan.
    double modalityUnexplained = 0.07;
    /// Standard deviation of the measurements of a modality [unit of the channel], > 0:
    /// what is closer is not told apart.
    double modalityNoise = 0.01;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<ModalityParams>& options();
};

/// A map models at most so many modalities.
constexpr int kMaxModalities = 8;

/// Parameters of all stages, in the order of the pipeline.
struct MapParams {
    FilterParams filter;
    NoveltyParams novelty;
    CellParams cells;
    EmParams em;
    HierarchyParams hierarchy;
    OccupancyParams occupancy;
    CarvingParams carving;
    ModalityParams modality;
    /// Names of the channels to model (Scan::channels), at most kMaxModalities; scans may
    /// lack them.
    Names modalities;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
    HGMM_EXPORT static const OptionTable<MapParams>& options();
    HGMM_EXPORT bool operator==(const MapParams& o) const;
    bool operator!=(const MapParams& o) const { return !(*this == o); }

    /// Sets resolution_m [m] and gives each length that follows it its default ratio to it,
    /// within its range; a length that is assigned afterwards has its own value.
    HGMM_EXPORT void setResolution(double resolution_m);
};

/// Options that maps had once.
HGMM_EXPORT const std::vector<RetiredOption>& retiredOptions();

/// Calls visit(stage...) for each struct of a stage, in the order of the pipeline, of one
/// or more MapParams; and last for the MapParams themselves, whose table has their own
/// fields.
template <typename Visitor, typename... Params>
void forEachStage(Visitor&& visit, Params&... params) {
    visit(params.filter...);
    visit(params.novelty...);
    visit(params.cells...);
    visit(params.em...);
    visit(params.hierarchy...);
    visit(params.occupancy.band...);
    visit(params.occupancy.freeSpace...);
    visit(params.occupancy.coverage...);
    visit(params.occupancy...);
    visit(params.carving...);
    visit(params.modality...);
    visit(params...);
}

/// Calls visit(row, field) for each option. Names are unique over all stages.
template <typename Params, typename Visitor>
void forEachOption(Params& params, Visitor&& visit) {
    forEachStage([&](auto& stage) { forEachRow(stage, visit); }, params);
}

/// Calls visit(row, field) for each option that is a number, a double or an int.
template <typename Params, typename Visitor>
void forEachNumber(Params& params, Visitor&& visit) {
    forEachOption(params, [&](const OptionRow& row, auto& field) {
        if constexpr (isNumber<decltype(field)>) visit(row, field);
    });
}

}  // namespace hgmm
