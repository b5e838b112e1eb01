#pragma once
#include <mrpt/config/CConfigFileBase.h>

#include <optional>
#include <string>

#include "options/option_fields.h"

namespace hgmm::mrpt_bridge {

/// Sets fields from the keys of a section that carry their name or their former name.
///
/// Throws std::invalid_argument for a value that cannot be read or is out of range, naming
/// it and the key that the section has; and for an option that maps had once.
/// Other keys are reported on stderr, with the section that they belong to or the name that
/// was probably meant.
void readSection(const OptionFields& fields, const mrpt::config::CConfigFileBase& source,
                 const std::string& section);

/// Reports keys of a section that no field has, as readSection does.
void warnOfUnknownKeys(const OptionFields& fields,
                       const mrpt::config::CConfigFileBase& source,
                       const std::string& section);

/// The number that a section gives an option by its present name; nothing if it gives none.
std::optional<double> numberIn(const mrpt::config::CConfigFileBase& source,
                               const std::string& section, const std::string& name);

}  // namespace hgmm::mrpt_bridge
