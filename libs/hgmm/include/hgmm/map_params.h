#pragma once
#include <string>
#include <vector>

#include "hgmm/cells.h"
#include "hgmm/contradiction.h"
#include "hgmm/em.h"
#include "hgmm/filter.h"
#include "hgmm/hierarchy.h"
#include "hgmm/modality_params.h"
#include "hgmm/novelty.h"
#include "hgmm/occupancy_model.h"

namespace hgmm {

/// Parameters of all stages, in the order of the pipeline.
struct MapParams {
    FilterParams filter;
    NoveltyParams novelty;
    CellParams cells;
    EmParams em;
    HierarchyParams hierarchy;
    OccupancyParams occupancy;
    ContradictionParams contradiction;
    ModalityParams modality;
    /// Names of the channels to model (Scan::channels), at most kMaxModalities; scans may
    /// lack them.
    std::vector<std::string> modalities;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// Calls visit(name, member) for every field of `params` (const or not), members being
/// double or int: the one list of fields for saving, reading configuration files and
/// printing. Names are unique over all stages and are the keys of configuration files.
template <typename Params, typename Visitor>
void forEachField(Params& params, Visitor&& visit) {
    visit("leafAtOneMetre_m", params.filter.leafAtOneMetre_m);
    visit("minLeaf_m", params.filter.minLeaf_m);
    visit("minRange_m", params.filter.minRange_m);
    visit("maxRange_m", params.filter.maxRange_m);
    visit("noiseStd_m", params.filter.noiseStd_m);
    visit("noisePerRange", params.filter.noisePerRange);
    visit("maxMahalanobis", params.novelty.maxMahalanobis);
    visit("maxThickness", params.novelty.maxThickness);
    visit("cellAtOneMetre_m", params.cells.cellAtOneMetre_m);
    visit("minCell_m", params.cells.minCell_m);
    visit("minSamples", params.cells.minSamples);
    visit("maxIterations", params.em.maxIterations);
    visit("minImprovement", params.em.minImprovement);
    visit("levels", params.hierarchy.levels);
    visit("similarityStart", params.hierarchy.similarityStart);
    visit("similarityStep", params.hierarchy.similarityStep);
    visit("similarityMax", params.hierarchy.similarityMax);
    visit("levelRatio", params.hierarchy.levelRatio);
    visit("freeShare", params.occupancy.band.freeShare);
    visit("bandBase_m", params.occupancy.band.bandBase_m);
    visit("bandPerRange", params.occupancy.band.bandPerRange);
    visit("bandReachPerRange", params.occupancy.band.bandReachPerRange);
    visit("freeSpaceModel", params.occupancy.freeSpace.freeSpaceModel);
    visit("freeCellAtOneMetre_m", params.occupancy.freeSpace.freeCellAtOneMetre_m);
    visit("freeSettledScans", params.occupancy.freeSpace.freeSettledScans);
    visit("knownSigmas", params.occupancy.knownSigmas);
    visit("extentSigmas", params.occupancy.extentSigmas);
    visit("contradictedKeep", params.contradiction.contradictedKeep);
    visit("minSupport", params.contradiction.minSupport);
    visit("modalityLeafAtOneMetre_m", params.modality.modalityLeafAtOneMetre_m);
    visit("modalityUnexplained", params.modality.modalityUnexplained);
    visit("modalityNoise", params.modality.modalityNoise);
}

}  // namespace hgmm
