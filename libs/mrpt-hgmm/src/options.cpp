#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <stdexcept>

#include "hgmm/params.h"
#include "option_fields.h"

using mrpt::config::CConfigFileBase;
using Insertion = mrpt::maps::CHGMMOccupancyMap::TInsertionOptions;
using Likelihood = mrpt::maps::CHGMMOccupancyMap::TLikelihoodOptions;
using Render = mrpt::maps::CHGMMOccupancyMap::TRenderOptions;

namespace hgmm::mrpt_bridge {

OptionFields fieldsOf(Insertion& options) {
    OptionFields fields;
    forEachField(options.params, [&](const char* name, auto& member) {
        fields.push_back({name, &member});
    });
    fields.push_back({"modalities", &options.params.modalities});
    return fields;
}

bool sameParams(const MapParams& a, const MapParams& b) {
    std::vector<double> of_a, of_b;
    forEachField(a, [&](const char*, const auto& value) { of_a.push_back(double(value)); });
    forEachField(b, [&](const char*, const auto& value) { of_b.push_back(double(value)); });
    return of_a == of_b && a.modalities == b.modalities;
}

OptionFields fieldsOf(Likelihood& options) {
    return {{"softening_m", &options.softening_m},
            {"outlierRatio", &options.outlierRatio},
            {"maxPoints", &options.maxPoints},
            {"independentPoints", &options.independentPoints},
            {"minRange_m", &options.minRange_m},
            {"maxRange_m", &options.maxRange_m}};
}

OptionFields fieldsOf(Render& options) {
    return {{"level", &options.level},
            {"drawEllipsoids", &options.drawEllipsoids},
            {"drawFreeSpace", &options.drawFreeSpace},
            {"drawVoxels", &options.drawVoxels},
            {"sigmas", &options.sigmas},
            {"maxEllipsoids", &options.maxEllipsoids},
            {"colour", &options.colour, "colourByWeight"},
            {"modality", &options.modality},
            {"voxelResolution_m", &options.voxelResolution_m},
            {"minOccupied", &options.minOccupied},
            {"generateOccupiedVoxels", &options.generateOccupiedVoxels},
            {"visibleOccupiedVoxels", &options.visibleOccupiedVoxels},
            {"generateFreeVoxels", &options.generateFreeVoxels},
            {"visibleFreeVoxels", &options.visibleFreeVoxels},
            {"generateGridLines", &options.generateGridLines}};
}

void LikelihoodParams::validate() const {
    requireInRange("softening_m", softening_m, 0.0, 10.0);
    requireInRange("outlierRatio", outlierRatio, 1e-9, 1.0 - 1e-9);
    requireInRange("maxPoints", maxPoints, 1, kMaxPoints);
    requireInRange("independentPoints", independentPoints, 1, kMaxPoints);
    requireInRange("minRange_m", minRange_m, 0.0, 1e6);
    requireInRange("maxRange_m", maxRange_m, minRange_m, 1e6);
}

bool LikelihoodParams::operator==(const LikelihoodParams& o) const {
    return softening_m == o.softening_m && outlierRatio == o.outlierRatio &&
           maxPoints == o.maxPoints && independentPoints == o.independentPoints &&
           minRange_m == o.minRange_m && maxRange_m == o.maxRange_m;
}

void RenderParams::validate() const {
    requireInRange("level", level, 0, 1000);
    requireInRange("sigmas", sigmas, 0.01, 10.0);
    requireInRange("maxEllipsoids", maxEllipsoids, 1, 1e7);
    requireInRange("colour", colour, 0, static_cast<int>(EllipsoidColour::kModality));
    if (voxelResolution_m != 0.0)
        requireInRange("voxelResolution_m", voxelResolution_m, 1e-4, 1e4);
    requireInRange("minOccupied", minOccupied, 0.01, 0.99);
}

namespace {

void validate(const Insertion& options) {
    options.params.validate();
}
template <typename Options>
void validate(const Options& options) {
    options.validate();
}

/// Reads into a copy, so that options stay as they were if a value is bad.
template <typename Options>
void load(Options& options, const CConfigFileBase& source, const std::string& section) {
    Options loaded = options;
    readSection(fieldsOf(loaded), source, section);
    try {
        validate(loaded);
    } catch (const std::invalid_argument& e) {
        throw std::invalid_argument("[" + section + "] " + e.what());
    }
    options = loaded;
}

template <typename Options>
void save(Options options, CConfigFileBase& target, const std::string& section) {
    writeSection(fieldsOf(options), target, section);
}

template <typename Options>
void dump(Options options, const char* title, std::ostream& out) {
    print(fieldsOf(options), title, out);
}

}  // namespace

}  // namespace hgmm::mrpt_bridge

namespace mrpt::maps {

namespace bridge = ::hgmm::mrpt_bridge;

void Insertion::loadFromConfigFile(const CConfigFileBase& source,
                                   const std::string& section) {
    bridge::load(*this, source, section);
}
void Insertion::saveToConfigFile(CConfigFileBase& target,
                                 const std::string& section) const {
    bridge::save(*this, target, section);
}
void Insertion::dumpToTextStream(std::ostream& out) const {
    bridge::dump(*this, "CHGMMOccupancyMap insertion options", out);
}

void Likelihood::loadFromConfigFile(const CConfigFileBase& source,
                                    const std::string& section) {
    bridge::load(*this, source, section);
}
void Likelihood::saveToConfigFile(CConfigFileBase& target,
                                  const std::string& section) const {
    bridge::save(*this, target, section);
}
void Likelihood::dumpToTextStream(std::ostream& out) const {
    bridge::dump(*this, "CHGMMOccupancyMap likelihood options", out);
}

void Render::loadFromConfigFile(const CConfigFileBase& source, const std::string& section) {
    bridge::load(*this, source, section);
}
void Render::saveToConfigFile(CConfigFileBase& target, const std::string& section) const {
    bridge::save(*this, target, section);
}
void Render::dumpToTextStream(std::ostream& out) const {
    bridge::dump(*this, "CHGMMOccupancyMap render options", out);
}

}  // namespace mrpt::maps
