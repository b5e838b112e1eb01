#include "hgmm/evaluation/configured_baselines.h"

#include <mrpt/config/CConfigFile.h>
#include <mrpt/core/format.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "maps/configured_maps.h"

namespace hgmm::evaluation {
namespace {

constexpr char kOwnClass[] = "mrpt::maps::CHGMMOccupancyMap";

struct Definition {
    std::string section, name;
    std::shared_ptr<mrpt::maps::TMetricMapInitializer> initializer;
};

/// The message of an MRPT exception, without the call stack that surrounds it.
std::string messageIn(const std::string& what) {
    static const std::string kLabel = "Message:";
    const std::size_t label = what.find(kLabel);
    if (label == std::string::npos) return what;
    const std::size_t begin = what.find_first_not_of(' ', label + kLabel.size());
    return what.substr(begin, what.find('\n', begin) - begin);
}

/// What `kind_count = n` in a section defines: nothing if no class goes by that name.
void appendDefinitions(const mrpt::config::CConfigFile& config, const std::string& section,
                       const std::string& kind, std::vector<Definition>& definitions) {
    const auto& registry = mrpt::maps::internal::TMetricMapTypesRegistry::Instance();
    if (registry.getAllRegistered().count(kind) == 0) return;
    const int count = config.read_int(section, kind + "_count", 0, true);
    for (int i = 0; i < count; ++i) {
        Definition definition;
        definition.section = section;
        definition.name = mrpt::format("%s_%02d", kind.c_str(), i);
        definition.initializer =
            decltype(definition.initializer)(registry.factoryMapDefinition(kind));
        if (definition.initializer->getMetricMapClassType()->className ==
            std::string(kOwnClass))
            return;
        definition.initializer->loadFromConfigFile(config, section + "_" + definition.name);
        definitions.push_back(std::move(definition));
    }
}

std::vector<Definition> definitionsIn(const mrpt::config::CConfigFile& config) {
    static const std::string kSuffix = "_count";
    std::vector<Definition> definitions;
    std::vector<std::string> sections, keys;
    config.getAllSections(sections);
    for (const std::string& section : sections) {
        config.getAllKeys(section, keys);
        for (const std::string& key : keys)
            if (key.size() > kSuffix.size() &&
                key.compare(key.size() - kSuffix.size(), kSuffix.size(), kSuffix) == 0)
                appendDefinitions(config, section,
                                  key.substr(0, key.size() - kSuffix.size()), definitions);
    }
    return definitions;
}

}  // namespace

std::vector<std::pair<std::string, std::unique_ptr<Baseline>>> configuredBaselines(
    const std::string& file) {
    if (!std::filesystem::is_regular_file(file) || !std::ifstream(file))
        throw std::runtime_error(file + ": cannot be read");
    std::vector<std::pair<std::string, std::unique_ptr<Baseline>>> baselines;
    try {
        const mrpt::config::CConfigFile config(file);
        const std::vector<Definition> definitions = definitionsIn(config);
        std::multiset<std::string> names;
        for (const Definition& definition : definitions) names.insert(definition.name);
        const auto& registry = mrpt::maps::internal::TMetricMapTypesRegistry::Instance();
        for (const Definition& definition : definitions) {
            const mrpt::maps::CMetricMap::Ptr map(
                registry.factoryMapObjectFromDefinition(*definition.initializer));
            const std::string prefix =
                names.count(definition.name) > 1 ? definition.section + "/" : "";
            baselines.emplace_back(prefix + definition.name, baselineOf(map));
        }
    } catch (const std::exception& error) {
        throw std::runtime_error(file + ": " + messageIn(error.what()));
    }
    return baselines;
}

}  // namespace hgmm::evaluation
