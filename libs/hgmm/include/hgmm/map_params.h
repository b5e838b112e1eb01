#pragma once
#include "hgmm/cells.h"
#include "hgmm/em.h"
#include "hgmm/filter.h"
#include "hgmm/hierarchy.h"
#include "hgmm/novelty.h"

namespace hgmm {

/// Parameters of all stages, in the order of the pipeline.
struct MapParams {
    FilterParams filter;
    NoveltyParams novelty;
    CellParams cells;
    EmParams em;
    HierarchyParams hierarchy;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// Calls visit(name, member) for every field of `params` (const or not), members being
/// double or int: the one list of fields for saving, reading configuration files and
/// printing. Names are unique over all stages and are the keys of configuration files.
template <typename Params, typename Visitor>
void forEachField(Params& params, Visitor&& visit) {
    visit("leafPerRange", params.filter.leafPerRange);
    visit("minLeaf_m", params.filter.minLeaf_m);
    visit("minRange_m", params.filter.minRange_m);
    visit("maxRange_m", params.filter.maxRange_m);
    visit("noiseStd_m", params.filter.noiseStd_m);
    visit("noisePerRange", params.filter.noisePerRange);
    visit("maxMahalanobis", params.novelty.maxMahalanobis);
    visit("cellPerRange", params.cells.cellPerRange);
    visit("minCell_m", params.cells.minCell_m);
    visit("minSamples", params.cells.minSamples);
    visit("maxIterations", params.em.maxIterations);
    visit("minImprovement", params.em.minImprovement);
    visit("levels", params.hierarchy.levels);
    visit("similarityStart", params.hierarchy.similarityStart);
    visit("similarityStep", params.hierarchy.similarityStep);
    visit("similarityMax", params.hierarchy.similarityMax);
    visit("levelRatio", params.hierarchy.levelRatio);
}

}  // namespace hgmm
