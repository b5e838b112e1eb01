#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

#include "cloud_layout.h"

namespace hgmm::importer {

/// The header of a PCD file.
struct PcdHeader {
    CloudLayout layout;
    std::string data;            ///< ascii, binary or binary_compressed
    std::size_t dataOffset = 0;  ///< bytes of the file before the data
    std::optional<Eigen::Vector3d> viewpoint;
};

/// Parses the header at the beginning of a PCD file's bytes. Throws std::runtime_error with
/// the cause, without the file's name.
PcdHeader parsePcdHeader(const std::string& bytes);

}  // namespace hgmm::importer
