#pragma once
#include <string>
#include <vector>

namespace hgmm::mrpt_bridge {

/// An option as a configuration file knows it.
struct OptionInfo {
    std::string section;       ///< end of its section's name: "insertOpts"
    std::string name;          ///< its key
    std::string formerName;    ///< a key that older files have, read as well; or empty
    std::string defaultValue;  ///< as a file holds it; empty for an empty text
    std::string unit;          ///< "m", "1", "count"; empty for texts and switches
    std::string range;         ///< "0.005 to 10", "true or false", "text", "names"
    std::string doc;           ///< one line
    bool isBasic = false;      ///< whether most users meet it
};

/// All options of a map, by section, in the order of their tables.
std::vector<OptionInfo> listOptions();

}  // namespace hgmm::mrpt_bridge
