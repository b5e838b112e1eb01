#include "hgmm/params.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace hgmm {

void FilterParams::validate() const {
    requireOptionsInRange(*this);
}
void NoveltyParams::validate() const {
    requireOptionsInRange(*this);
}
void CellParams::validate() const {
    requireOptionsInRange(*this);
}
void EmParams::validate() const {
    requireOptionsInRange(*this);
}
void HierarchyParams::validate() const {
    requireOptionsInRange(*this);
}
void FreeSpaceBandParams::validate() const {
    requireOptionsInRange(*this);
}
void FreeSpaceParams::validate() const {
    requireOptionsInRange(*this);
}
void CoverageParams::validate() const {
    requireOptionsInRange(*this);
}
void CarvingParams::validate() const {
    requireOptionsInRange(*this);
}
void ModalityParams::validate() const {
    requireOptionsInRange(*this);
}

void OccupancyParams::validate() const {
    band.validate();
    freeSpace.validate();
    coverage.validate();
    requireOptionsInRange(*this);
}

void MapParams::validate() const {
    forEachStage([](const auto& stage) { requireOptionsInRange(stage); }, *this);
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

bool MapParams::operator==(const MapParams& o) const {
    bool same = true;
    forEachStage([&](const auto& a, const auto& b) { same = same && sameOptions(a, b); },
                 *this, o);
    return same;
}

void MapParams::setResolution(double resolution_m) {
    const MapParams defaults;
    const double ratio = resolution_m / defaults.filter.resolution_m;
    forEachStage(
        [&](auto& stage, const auto& byDefault) {
            for (const auto& row : stage.options())
                if (const auto* member =
                        std::get_if<double std::decay_t<decltype(stage)>::*>(&row.member);
                    member && row.scales)
                    stage.** member =
                        std::clamp(byDefault.**member * ratio, row.low, row.high);
        },
        *this, defaults);
    filter.resolution_m = resolution_m;
}

}  // namespace hgmm
