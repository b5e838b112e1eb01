#pragma once
#include <string>

#include "recorded_cloud.h"

namespace hgmm::importer {

/// Reads the vertices of a PLY file (ascii, binary of either byte order) as points;
/// properties may be of any order and type (CloudFields), and what follows the vertices,
/// such as faces, is skipped. Throws std::runtime_error that names the file if it is no
/// such file, is shorter than its header says, has lists among or before the vertices, or
/// no vertices.
RecordedCloud readPly(const std::string& file);

}  // namespace hgmm::importer
