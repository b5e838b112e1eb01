#pragma once
#include <string>

#include "recorded_cloud.h"

namespace hgmm::importer {

/// Reads a file of the Point Cloud Library, version 0.7, with DATA ascii, binary or
/// binary_compressed. Fields may be of any order, size and type (CloudFields). Zero bytes
/// and blanks after the last point are accepted. Throws std::runtime_error that names the
/// file if it is no such file, is shorter than its header says, or has other bytes after
/// the last point.
RecordedCloud readPcd(const std::string& file);

}  // namespace hgmm::importer
