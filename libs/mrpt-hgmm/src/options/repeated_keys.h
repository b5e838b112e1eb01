#pragma once
#include <mrpt/config/CConfigFileBase.h>

#include <string>

namespace hgmm::mrpt_bridge {

/// Reports keys that a configuration gives twice under one heading of a map's section. The
/// last value is read. (A section that appears again is a way to override values.) Only
/// files can be looked into: other sources have lost the first value.
/// @param prefix of the map's sections: "<parent>_hgmmMap_00"
void warnOfRepeatedKeys(const mrpt::config::CConfigFileBase& source,
                        const std::string& prefix);

}  // namespace hgmm::mrpt_bridge
