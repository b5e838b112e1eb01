#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace hgmm::importer {

/// One column of a cloud file.
struct CloudField {
    std::string name;
    char type = 'F';         ///< F float, I signed, U unsigned
    std::size_t size = 4;    ///< bytes of one element: 1, 2, 4 or 8 (F: 4 or 8)
    std::size_t count = 1;   ///< elements of a point
    std::size_t column = 0;  ///< elements of a point before this field
    std::size_t offset = 0;  ///< bytes of a point before this field
};

/// How the points of a cloud file are stored.
struct CloudLayout {
    std::vector<CloudField> fields;
    std::size_t points = 0;
    std::size_t columns = 0;  ///< elements of a point
    std::size_t stride = 0;   ///< bytes of a point

    /// Appends a field behind those that are there.
    void add(CloudField field);
    /// The first field of a name, in letters of any case, or null.
    const CloudField* find(const std::string& name) const;
};

}  // namespace hgmm::importer
