#include <mrpt/config/CConfigFile.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <filesystem>
#include <ostream>

#include "options/modality_warnings.h"
#include "options/option_fields.h"
#include "options/read_options.h"
#include "options/repeated_keys.h"
#include "options/section_names.h"

namespace fs = std::filesystem;
namespace bridge = ::hgmm::mrpt_bridge;

namespace mrpt::maps {

MAP_DEFINITION_REGISTER("mrpt::maps::CHGMMOccupancyMap,hgmmMap",
                        mrpt::maps::CHGMMOccupancyMap)

namespace {

std::string resolved(const std::string& fileName,
                     const mrpt::config::CConfigFileBase& source) {
    const auto* config = dynamic_cast<const mrpt::config::CConfigFile*>(&source);
    if (fileName.empty() || !config || fs::path(fileName).is_absolute() ||
        fs::exists(fileName))
        return fileName;
    const fs::path beside = fs::path(config->getAssociatedFile()).parent_path() / fileName;
    return fs::exists(beside) ? beside.string() : fileName;
}

}  // namespace

CHGMMOccupancyMap::TMapDefinition::TMapDefinition() = default;

void CHGMMOccupancyMap::TMapDefinition::loadFromConfigFile_map_specific(
    const mrpt::config::CConfigFileBase& source, const std::string& prefix) {
    const std::string creation = prefix + "_creationOpts";
    bridge::CreationOptions known;
    bridge::warnOfUnknownKeys(bridge::fieldsOf(known), source, creation);
    bridge::warnOfUnreadSections(source, prefix);
    bridge::warnOfRepeatedKeys(source, prefix);

    load_file = resolved(source.read_string(creation, "load_file", load_file), source);
    insertionOpts.loadFromConfigFile(source, prefix + "_insertOpts");
    likelihoodOpts.loadFromConfigFile(source, prefix + "_likelihoodOpts");
    renderOpts.loadFromConfigFile(source, prefix + "_renderOpts");
    bridge::warnOfForeignModalities(insertionOpts.params.modalities,
                                    prefix + "_insertOpts");
}

void CHGMMOccupancyMap::TMapDefinition::dumpToTextStream_map_specific(
    std::ostream& out) const {
    out << "load_file = " << load_file << "\n\n";
    insertionOpts.dumpToTextStream(out);
    likelihoodOpts.dumpToTextStream(out);
    renderOpts.dumpToTextStream(out);
}

bridge::NewMap CHGMMOccupancyMap::internal_CreateFromMapDefinition(
    const TMetricMapInitializer& definition) {
    const auto& ours = dynamic_cast<const TMapDefinition&>(definition);
    auto map = std::make_unique<CHGMMOccupancyMap>();
    if (!ours.load_file.empty()) map->loadFromFile(ours.load_file);
    const double scaleOfFile = map->insertionOptions.reading.intensityScale;
    map->insertionOptions = ours.insertionOpts;
    // Parameters without the modalities of a map would make it forget them.
    auto& modalities = map->insertionOptions.params.modalities;
    if (modalities.empty()) modalities = map->model().modalities();
    // Nor may the scale of its intensities change.
    double& scale = map->insertionOptions.reading.intensityScale;
    if (scale == 0.0) scale = scaleOfFile;
    map->likelihoodOptions = ours.likelihoodOpts;
    map->renderOptions = ours.renderOpts;
    map->genericMapParams = ours.genericMapParams;
    map->model().setParams(map->insertionOptions.params);
    return bridge::NewMap(map.release());
}

}  // namespace mrpt::maps
