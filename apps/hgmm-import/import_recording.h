#pragma once
#include <cstddef>

#include "recording_writer.h"
#include "sources/source.h"

namespace hgmm::importer {

/// Loads every step-th scan of a source and writes it; a progress line on stderr if that is
/// a terminal, a summary on stdout at the end.
void importRecording(const Source& source, const RecordingOutputs& outputs,
                     std::size_t step);

}  // namespace hgmm::importer
