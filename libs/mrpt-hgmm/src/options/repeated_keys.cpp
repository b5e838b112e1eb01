#include "options/repeated_keys.h"

#include <mrpt/config/CConfigFile.h>

#include <fstream>
#include <set>

#include "warnings.h"

namespace hgmm::mrpt_bridge {

namespace {

std::string withoutBlanks(std::string text) {
    text.erase(text.find_last_not_of(" \t\r") + 1);
    text.erase(0, text.find_first_not_of(" \t"));
    return text;
}

}  // namespace

void warnOfRepeatedKeys(const mrpt::config::CConfigFileBase& source,
                        const std::string& prefix) {
    const auto* config = dynamic_cast<const mrpt::config::CConfigFile*>(&source);
    if (!config) return;
    std::ifstream file(config->getAssociatedFile());
    const std::string start = lowerCase(prefix) + "_";
    std::string section;
    std::set<std::string> keys;
    for (std::string line; std::getline(file, line);) {
        line = withoutBlanks(line);
        if (line.empty() || line[0] == ';' || line[0] == '#') continue;
        if (line[0] == '[') {
            section = line.substr(1, line.find(']') - 1);
            keys.clear();
            continue;
        }
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos || lowerCase(section).rfind(start, 0) != 0)
            continue;
        const std::string key = withoutBlanks(line.substr(0, equals));
        if (!keys.insert(lowerCase(key)).second)
            warn("key '" + key + "' appears twice in section [" + section +
                 "]; the last value is read");
    }
}

}  // namespace hgmm::mrpt_bridge
