#pragma once
#include <cstddef>

#include "recording_writer.h"
#include "sources/source.h"

namespace hgmm::importer {

/// Loads every step-th scan of a source and writes it; a progress line on stderr if that is
/// a terminal, a summary on stdout at the end. Scans that cannot be loaded are skipped,
/// with a warning. Throws std::runtime_error if none can, or if their ranges are not
/// credible (SourceSummary::expectedRange); no file appears then.
void importRecording(Source& source, const RecordingOutputs& outputs, std::size_t step);

}  // namespace hgmm::importer
