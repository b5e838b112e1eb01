#pragma once
#include <mrpt/config/CConfigFileBase.h>

#include <string>

namespace hgmm::mrpt_bridge {

/// The section of the same map that ends in `end`: "m_hgmmMap_00_renderOpts" for
/// "m_hgmmMap_00_insertOpts" and "renderOpts"; "..._renderOpts" where the name does not end
/// as sections of a map do.
std::string siblingSection(const std::string& section, const std::string& end);

/// Reports on stderr what a configuration says of maps and nobody reads: sections with
/// unknown ends, without the number of the map, with a number that is written in another
/// way or belongs to no map, or that no `hgmmMap_count` goes with; and options beside
/// `hgmmMap_count`.
/// @param prefix "<parent>_hgmmMap_00"; maps of one parent are told the same, which is said
/// once
void warnOfUnreadSections(const mrpt::config::CConfigFileBase& source,
                          const std::string& prefix);

}  // namespace hgmm::mrpt_bridge
