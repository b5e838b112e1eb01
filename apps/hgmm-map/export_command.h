#pragma once
#include <CLI/CLI.hpp>

#include "commands.h"

namespace maptool {

/// The --force of commands that write.
inline void addForce(CLI::App& command, bool& force) {
    command.add_flag("--force", force, "Replace an existing file of another kind, too");
}

/// Defines `hgmm-map export` and where its arguments go. Arguments that do not fit together
/// are usage errors.
CLI::App* defineExport(CLI::App& app, ExportOptions& exporting);

}  // namespace maptool
