#pragma once
#include <CLI/CLI.hpp>

#include "commands.h"

namespace maptool {

/// Defines `hgmm-map export` and where its arguments go. Arguments that do not fit together
/// are usage errors.
CLI::App* defineExport(CLI::App& app, ExportOptions& exporting);

}  // namespace maptool
