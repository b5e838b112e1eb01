#pragma once
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <map>
#include <ostream>
#include <string>

/// Options with every value away from its default, so that a forgotten one shows.
namespace edited {

using mrpt::maps::CHGMMOccupancyMap;

/// A number or a text, to be compared and printed.
struct Value {
    Value() = default;
    Value(double n) : number(n) {}
    Value(const std::string& t) : text(t) {}

    bool operator==(const Value& o) const { return number == o.number && text == o.text; }
    bool operator!=(const Value& o) const { return !(*this == o); }

    double number = 0;
    std::string text;
};
inline std::ostream& operator<<(std::ostream& out, const Value& v) {
    return v.text.empty() ? out << v.number : out << v.text;
}
using Values = std::map<std::string, Value>;

inline Values values(const CHGMMOccupancyMap::TInsertionOptions& options) {
    Values values;
    std::string& modalities = values["modalities"].text;
    for (const std::string& name : options.params.modalities) modalities += name + ";";
    ::hgmm::forEachField(options.params, [&](const char* name, const auto& value) {
        values[name] = static_cast<double>(value);
    });
    return values;
}
inline Values values(const CHGMMOccupancyMap::TLikelihoodOptions& o) {
    return {{"softening_m", o.softening_m}, {"outlierRatio", o.outlierRatio},
            {"maxPoints", o.maxPoints},     {"independentPoints", o.independentPoints},
            {"minRange_m", o.minRange_m},   {"maxRange_m", o.maxRange_m}};
}
inline Values values(const CHGMMOccupancyMap::TRenderOptions& o) {
    return {{"level", o.level},
            {"drawEllipsoids", o.drawEllipsoids},
            {"drawFreeSpace", o.drawFreeSpace},
            {"drawVoxels", o.drawVoxels},
            {"sigmas", o.sigmas},
            {"maxEllipsoids", o.maxEllipsoids},
            {"colour", o.colour},
            {"modality", o.modality},
            {"voxelResolution_m", o.voxelResolution_m},
            {"minOccupied", o.minOccupied},
            {"generateOccupiedVoxels", o.generateOccupiedVoxels},
            {"visibleOccupiedVoxels", o.visibleOccupiedVoxels},
            {"generateFreeVoxels", o.generateFreeVoxels},
            {"visibleFreeVoxels", o.visibleFreeVoxels},
            {"generateGridLines", o.generateGridLines}};
}

inline void change(CHGMMOccupancyMap::TInsertionOptions& options) {
    ::hgmm::forEachField(options.params, [](const char*, auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>)
            value += 1;
        else
            value *= 0.875;  // exact in binary, inside every range
    });
    options.params.modalities = {"intensity", "water content"};
    options.params.validate();
}
inline void change(CHGMMOccupancyMap::TLikelihoodOptions& o) {
    o.softening_m = 0.2345;
    o.outlierRatio = 0.123;
    o.maxPoints = 77;
    o.independentPoints = 66;
    o.minRange_m = 0.45;
    o.maxRange_m = 33.3;
}
inline void change(CHGMMOccupancyMap::TRenderOptions& o) {
    o.sigmas = 1.25;
    o.level = 2;
    o.maxEllipsoids = 55;
    o.colour = 1;
    o.modality = "water content";
    o.drawEllipsoids = false;
    o.drawFreeSpace = true;
    o.drawVoxels = true;
    o.voxelResolution_m = 0.25;
    o.minOccupied = 0.625;
    o.generateOccupiedVoxels = false;
    o.visibleOccupiedVoxels = false;
    o.generateFreeVoxels = false;
    o.visibleFreeVoxels = false;
    o.generateGridLines = true;
}
inline void change(CHGMMOccupancyMap& map) {
    change(map.insertionOptions);
    change(map.likelihoodOptions);
    change(map.renderOptions);
    map.genericMapParams.enableObservationInsertion = false;
    map.genericMapParams.enableSaveAs3DObject = false;
}

inline Values all(const CHGMMOccupancyMap& map) {
    Values all = values(map.insertionOptions);
    all.merge(values(map.likelihoodOptions));
    all.merge(values(map.renderOptions));
    // These are in two option structs, with equal names.
    all["insertion minRange_m"] = map.insertionOptions.params.filter.minRange_m;
    all["insertion maxRange_m"] = map.insertionOptions.params.filter.maxRange_m;
    all["likelihood minRange_m"] = map.likelihoodOptions.minRange_m;
    all["likelihood maxRange_m"] = map.likelihoodOptions.maxRange_m;
    all["insertion"] = map.genericMapParams.enableObservationInsertion;
    all["3D"] = map.genericMapParams.enableSaveAs3DObject;
    all["likelihood"] = map.genericMapParams.enableObservationLikelihood;
    return all;
}

}  // namespace edited
