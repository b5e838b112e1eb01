#pragma once
#include <string>
#include <vector>

#include "hgmm/option.h"

namespace hgmm::mrpt_bridge {

/// Section `_creationOpts`. MRPT itself reads all but load_file.
struct CreationOptions {
    std::string load_file;  ///< saved map to start from, if not empty
    bool enableSaveAs3DObject = true, enableObservationLikelihood = true,
         enableObservationInsertion = true;

    static const OptionTable<CreationOptions>& options();
};

/// The rows of one section of a configuration.
struct SectionRows {
    const char* section;  ///< end of its name: "insertOpts"
    std::vector<const OptionRow*> rows;
};

/// All sections of a map: insertOpts, likelihoodOpts, renderOpts, creationOpts.
const std::vector<SectionRows>& allSections();

}  // namespace hgmm::mrpt_bridge
