#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <stdexcept>

#include "options/option_fields.h"
#include "options/read_options.h"

using mrpt::config::CConfigFileBase;
using Insertion = mrpt::maps::CHGMMOccupancyMap::TInsertionOptions;
using Likelihood = mrpt::maps::CHGMMOccupancyMap::TLikelihoodOptions;
using Render = mrpt::maps::CHGMMOccupancyMap::TRenderOptions;

namespace hgmm::mrpt_bridge {

namespace {

/// Lengths that a section does not give follow the resolution that it gives. A section with
/// the former name of resolution_m was written when none followed.
void prepare(Insertion& options, const CConfigFileBase& source,
             const std::string& section) {
    if (const auto resolution_m = numberIn(source, section, "resolution_m"))
        options.params.setResolution(*resolution_m);
}
template <typename Options>
void prepare(Options&, const CConfigFileBase&, const std::string&) {}

void validate(const Insertion& options) {
    options.params.validate();
    options.reading.validate();
}
template <typename Options>
void validate(const Options& options) {
    options.validate();
}

/// Reads into a copy, so that options stay as they were if a value is bad.
template <typename Options>
void load(Options& options, const CConfigFileBase& source, const std::string& section) {
    Options loaded = options;
    try {
        prepare(loaded, source, section);
        readSection(fieldsOf(loaded), source, section);
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
