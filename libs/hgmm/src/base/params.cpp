#include "hgmm/params.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "hgmm/occupancy.h"

namespace hgmm {

void FilterParams::validate() const {
    requireInRange("leafAtOneMetre_m", leafAtOneMetre_m, 5e-3, 10.0);
    requireInRange("minLeaf_m", minLeaf_m, 1e-4, 100.0);
    requireInRange("minRange_m", minRange_m, 0.0, 1e5);
    requireInRange("maxRange_m", maxRange_m, minRange_m, 1e5);
    requireInRange("noiseStd_m", noiseStd_m, 1e-4, 10.0);
    requireInRange("noisePerRange", noisePerRange, 0.0, 0.1);
}

void NoveltyParams::validate() const {
    requireInRange("maxMahalanobis", maxMahalanobis, 0.1, kReachSigmas);
    requireInRange("maxThickness", maxThickness, 1e-3, 1000.0);
}

void CellParams::validate() const {
    requireInRange("cellAtOneMetre_m", cellAtOneMetre_m, 1e-3, 100.0);
    requireInRange("minCell_m", minCell_m, 1e-3, 1e3);
    requireInRange("minSamples", minSamples, 1, 1e6);
}

void EmParams::validate() const {
    if (maxIterations < 0)
        throw std::invalid_argument("EmParams::maxIterations must not be negative");
    if (!(minImprovement >= 0) || std::isinf(minImprovement))
        throw std::invalid_argument(
            "EmParams::minImprovement must be finite and not negative");
}

void HierarchyParams::validate() const {
    if (levels < 1)
        throw std::invalid_argument("HierarchyParams::levels must be at least 1");
    if (!(similarityStart > 0) || std::isinf(similarityStart))
        throw std::invalid_argument(
            "HierarchyParams::similarityStart must be finite and positive");
    if (!(similarityStep >= 0) || std::isinf(similarityStep))
        throw std::invalid_argument(
            "HierarchyParams::similarityStep must be finite and not negative");
    requireInRange("similarityMax", similarityMax, 1e-6, kLargestSimilarity);
    requireInRange("levelRatio", levelRatio, 0.01, 0.99);
}

void FreeSpaceBandParams::validate() const {
    requireInRange("freeShare", freeShare, 0.01, 0.99);
    requireInRange("bandBase_m", bandBase_m, 1e-4, 1e3);
    requireInRange("bandPerRange", bandPerRange, 0.0, 1.0);
    requireInRange("bandReachPerRange", bandReachPerRange, 0.0, 1.0);
}

void FreeSpaceParams::validate() const {
    requireInRange("freeCellAtOneMetre_m", freeCellAtOneMetre_m, 1e-2, 100.0);
    requireInRange("freeSettledScans", freeSettledScans, 1.0, 1e6);
}

void OccupancyParams::validate() const {
    band.validate();
    freeSpace.validate();
    requireInRange("knownSigmas", knownSigmas, 1.0, 3.9);
    requireInRange("extentSigmas", extentSigmas, 1.0, knownSigmas);
}

void CarvingParams::validate() const {
    requireInRange("contradictedKeep", carvedSupport, 1e-6, 1.0);
    requireInRange("minSupport", minSupport, 0.0, 1e9);
}

void ModalityParams::validate() const {
    requireInRange("modalityLeafAtOneMetre_m", modalityLeafAtOneMetre_m, 5e-3, 10.0);
    requireInRange("modalityUnexplained", modalityUnexplained, 1e-3, 0.999);
    requireInRange("modalityNoise", modalityNoise, 1e-6, 1e6);
}

void MapParams::validate() const {
    filter.validate();
    novelty.validate();
    cells.validate();
    em.validate();
    hierarchy.validate();
    occupancy.validate();
    carving.validate();
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

}  // namespace hgmm
