#pragma once
#include <hgmm/mrpt_bridge/output_file.h>

#include <optional>
#include <string>

namespace hgmm::importer {

struct MapImport {
    std::string input;  ///< .bt, .ot, .yaml, .pcd or .ply
    std::string output;
    mrpt_bridge::Replace replace = mrpt_bridge::Replace::sameKind;
    std::optional<double> height_m;       ///< .yaml only: of the layer; 0 if not given
    std::optional<double> unitsPerMetre;  ///< .pcd and .ply only; 1 if not given
    std::optional<double> resolution_m;   ///< .pcd and .ply only: of the map
};

/// `hgmm-import map`: writes a map (.hgmm) that knows what another kind of map does, and
/// says what was read and what is unknown. Throws std::runtime_error naming the file.
void importMap(const MapImport& import);

}  // namespace hgmm::importer
