#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hgmm::importer {

/// One column of a PCD file.
struct PcdField {
    std::string name;
    char type = 'F';         ///< F float, I signed, U unsigned
    std::size_t size = 4;    ///< bytes of one element: 1, 2, 4 or 8 (F: 4 or 8)
    std::size_t count = 1;   ///< elements of a point
    std::size_t column = 0;  ///< elements of a point before this field
    std::size_t offset = 0;  ///< bytes of a point before this field
};

/// The header of a PCD file.
struct PcdHeader {
    std::vector<PcdField> fields;
    std::size_t points = 0;
    std::size_t columns = 0;     ///< elements of a point
    std::size_t stride = 0;      ///< bytes of a point
    std::string data;            ///< ascii, binary or binary_compressed
    std::size_t dataOffset = 0;  ///< bytes of the file before the data
    std::optional<Eigen::Vector3d> viewpoint;

    /// The field of a name, or null.
    const PcdField* find(const std::string& name) const;
};

/// Parses the header at the beginning of a PCD file's bytes. Throws std::runtime_error with
/// the cause, without the file's name.
PcdHeader parsePcdHeader(const std::string& bytes);

}  // namespace hgmm::importer
