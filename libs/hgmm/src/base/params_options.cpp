#include "hgmm/occupancy.h"
#include "hgmm/params.h"

namespace hgmm {

// The one table of a map's options: name, field, unit, range, what it is. Defaults are in
// hgmm/params.h.

const OptionTable<FilterParams>& FilterParams::options() {
    using P = FilterParams;
    static const OptionTable<P> table = {
        Option<P>("resolution_m", &P::resolution_m, "m", 5e-3, 10,
                  "edge of a leaf of the scan filter at range 1 m; grows with the square "
                  "root of the range; the lengths that follow it scale with it")
            .basic()
            .formerly("leafAtOneMetre_m"),
        Option<P>("minLeaf_m", &P::minLeaf_m, "m", 1e-4, 100, "smallest leaf edge")
            .followsResolution(),
        {"minRange_m", &P::minRange_m, "m", 0, 1e5, "nearer points are dropped"},
        Option<P>("maxRange_m", &P::maxRange_m, "m", 0, 1e5,
                  "farther points are no surfaces; their rays clear space up to here")
            .basic()
            .notBelow("minRange_m"),
        Option<P>("noiseStd_m", &P::noiseStd_m, "m", 1e-4, 10,
                  "standard deviation of a measured range, at range 0")
            .basic(),
        {"noisePerRange", &P::noisePerRange, "m/m", 0, 0.1, "its growth with the range"}};
    return table;
}

const OptionTable<NoveltyParams>& NoveltyParams::options() {
    using P = NoveltyParams;
    static const OptionTable<P> table = {
        {"maxMahalanobis", &P::maxMahalanobis, "sigma", 0.1, kReachSigmas,
         "a sample this near to one component is explained by it"},
        {"maxThickness", &P::maxThickness, "cells", 1e-3, 1000,
         "a thicker component explains no sample; in cell edges at the range of the ray"}};
    return table;
}

const OptionTable<CellParams>& CellParams::options() {
    using P = CellParams;
    static const OptionTable<P> table = {
        Option<P>(
            "cellAtOneMetre_m", &P::cellAtOneMetre_m, "m", 1e-3, 100,
            "edge of the cells of the first guess at range 1 m; grows with the square "
            "root of the range")
            .followsResolution(),
        Option<P>("minCell_m", &P::minCell_m, "m", 1e-3, 1e3, "smallest cell edge")
            .followsResolution(),
        {"minSamples", &P::minSamples, "count", 1, 1e6,
         "a cell with fewer samples joins one of twice its size"}};
    return table;
}

const OptionTable<EmParams>& EmParams::options() {
    using P = EmParams;
    static const OptionTable<P> table = {
        {"maxIterations", &P::maxIterations, "count", 0, 1e9,
         "iterations of expectation maximization, at most"},
        {"minImprovement", &P::minImprovement, "nat/point", 0, 1e9,
         "it stops when the log-likelihood gains less"}};
    return table;
}

const OptionTable<HierarchyParams>& HierarchyParams::options() {
    using P = HierarchyParams;
    static const OptionTable<P> table = {
        {"levels", &P::levels, "count", 1, 1000, "levels of the hierarchy that are kept"},
        {"similarityStart", &P::similarityStart, "nat", 1e-12, 1e9,
         "divergence below which the first pass merges two components"},
        {"similarityStep", &P::similarityStep, "nat", 0, 1e9,
         "added to it after each pass"},
        {"similarityMax", &P::similarityMax, "nat", 1e-6, kLargestSimilarity,
         "the finest level is merged no further than this divergence"},
        {"levelRatio", &P::levelRatio, "1", 0.01, 0.99,
         "a level has at most this share of the components of the level below"}};
    return table;
}

const OptionTable<FreeSpaceBandParams>& FreeSpaceBandParams::options() {
    using P = FreeSpaceBandParams;
    static const OptionTable<P> table = {
        {"freeShare", &P::freeShare, "1", 0.01, 0.99,
         "share of free points among all points within the band in front of a surface"},
        Option<P>("bandBase_m", &P::bandBase_m, "m", 1e-4, 1e3,
                  "width of the band at range 0")
            .followsResolution(),
        {"bandPerRange", &P::bandPerRange, "m/m", 0, 1, "its growth with the range"},
        {"bandReachPerRange", &P::bandReachPerRange, "m/m", 0, 1,
         "reach of the free space of a surface, for each metre of range"}};
    return table;
}

const OptionTable<FreeSpaceParams>& FreeSpaceParams::options() {
    using P = FreeSpaceParams;
    static const OptionTable<P> table = {
        Option<P>("freeCellAtOneMetre_m", &P::freeCellAtOneMetre_m, "m", 1e-2, 100,
                  "edge of the smallest cells of free space at range 1 m; grows with the "
                  "square root of the range")
            .followsResolution(),
        {"freeSettledScans", &P::freeSettledScans, "scans", 1, 1e6,
         "a free component that holds this many scans learns no more"}};
    return table;
}

const OptionTable<CoverageParams>& CoverageParams::options() {
    using P = CoverageParams;
    static const OptionTable<P> table = {
        Option<P>("coverageCellAtOneMetre_m", &P::coverageCellAtOneMetre_m, "m", 1e-2, 100,
                  "edge of the cells of space that rays passed, 1 m from the sensor; grows "
                  "with the square root of the distance")
            .followsResolution()};
    return table;
}

const OptionTable<OccupancyParams>& OccupancyParams::options() {
    using P = OccupancyParams;
    static const OptionTable<P> table = {
        {"knownSigmas", &P::knownSigmas, "sigma", 1, 3.9,
         "a point this far behind a surface is as likely unknown as known"},
        Option<P>("extentSigmas", &P::extentSigmas, "sigma", 1, 3.9,
                  "the same beside a surface")
            .notAbove("knownSigmas")};
    return table;
}

const OptionTable<CarvingParams>& CarvingParams::options() {
    using P = CarvingParams;
    static const OptionTable<P> table = {
        Option<P>("carvedSupport", &P::carvedSupport, "1", 1e-6, 1,
                  "share of its support that a surface keeps each time that a scan sees "
                  "through it; 1: rays remove no surface")
            .basic()
            .formerly("contradictedKeep"),
        {"minSupport", &P::minSupport, "count", 0, 1e9,
         "a component with less support is removed"}};
    return table;
}

const OptionTable<ModalityParams>& ModalityParams::options() {
    using P = ModalityParams;
    static const OptionTable<P> table = {
        Option<P>("modalityLeafAtOneMetre_m", &P::modalityLeafAtOneMetre_m, "m", 5e-3, 10,
                  "edge of a leaf of a modality at range 1 m")
            .followsResolution(),
        {"modalityUnexplained", &P::modalityUnexplained, "1", 1e-3, 0.999,
         "share of a scan's variance that the components of a modality need not explain"},
        {"modalityNoise", &P::modalityNoise, "channel's", 1e-6, 1e6,
         "standard deviation of the measurements of a modality"}};
    return table;
}

const OptionTable<MapParams>& MapParams::options() {
    static const OptionTable<MapParams> table = {
        Option<MapParams>("modalities", &MapParams::modalities,
                          "channels to model besides the surface, separated by commas; rgb "
                          "is short for r, g, b")
            .basic()};
    return table;
}

const std::vector<RetiredOption>& retiredOptions() {
    static const std::vector<RetiredOption> retired = {
        {"freeSpaceModel",
         "the thesis' own free space is no part of the map any more; hgmm-replay --study "
         "free-space shows it"}};
    return retired;
}

}  // namespace hgmm
