#pragma once
#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <functional>
#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

/// Options as tables of named fields: one table per struct, from which configuration files
/// are read and written, options printed and serialised.
namespace hgmm::mrpt_bridge {

/// Names separated by commas, where "rgb" is short for "r, g, b".
using Names = std::vector<std::string>;

struct OptionField {
    const char* name;  ///< of the member and of the key
    std::variant<double*, int*, bool*, std::string*, Names*> member;
    const char* formerName = nullptr;  ///< under which version 0 of the archive holds it

    bool isText() const {
        return std::holds_alternative<std::string*>(member) ||
               std::holds_alternative<Names*>(member);
    }
    bool isStoredAs(const std::string& stored) const {
        return stored == name || (formerName && stored == formerName);
    }
};
using OptionFields = std::vector<OptionField>;

OptionFields fieldsOf(mrpt::maps::CHGMMOccupancyMap::TInsertionOptions& options);
OptionFields fieldsOf(mrpt::maps::CHGMMOccupancyMap::TLikelihoodOptions& options);
OptionFields fieldsOf(mrpt::maps::CHGMMOccupancyMap::TRenderOptions& options);

/// The value of a field that is no text as a number (a bool is 0 or 1), and back; int and
/// bool members take the nearest.
double numberOf(const OptionField& field);
void setNumber(const OptionField& field, double value);

/// The value as a configuration file holds it, and back. Throws std::invalid_argument,
/// saying what it must be, for a text that is none.
std::string textOf(const OptionField& field);
void setText(const OptionField& field, const std::string& text);

/// Whether all parameters are equal.
bool sameParams(const MapParams& a, const MapParams& b);

/// Sets members from the keys of a section that carry their name. Throws
/// std::invalid_argument for a value that cannot be read, naming section, key and value.
/// Keys of other names are reported on stderr.
void readSection(const OptionFields& fields, const mrpt::config::CConfigFileBase& source,
                 const std::string& section);
void writeSection(const OptionFields& fields, mrpt::config::CConfigFileBase& target,
                  const std::string& section);
void print(const OptionFields& fields, const std::string& title, std::ostream& out);

/// Reports names of a configuration that are not among `known` on stderr, with the nearest
/// one.
/// @param what what the names are: "key", "section"
void warnOfUnknown(const std::vector<std::string>& names,
                   const std::vector<std::string>& known, const std::string& what,
                   const std::string& where);

}  // namespace hgmm::mrpt_bridge
