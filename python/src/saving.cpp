#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>

#include "archive.h"
#include "arrays.h"
#include "map_file.h"
#include "shared_map.h"

namespace hgmm::python {

namespace {

constexpr const char* kSaveDoc =
    R"(Writes a file that the tools and MRPT's programs read (`.hgmm`, docs/formats.md).

file: text or path.
exact: whether every bit is kept, so that the map goes on as this one would. Compact files are
    less than half as large, with errors well below a component's own size.

Options of MRPT's programs, likelihood and display, have their defaults in the file. A file that
cannot be written completely leaves the old one in place. Raises OSError. Releases the GIL.)";

constexpr const char* kLoadDoc =
    R"(Reads a saved map: a `.hgmm` file, or a file that holds the bytes of to_bytes().

file: text or path.

MRPT is not needed. Raises OSError for a file that cannot be read and FormatError, which is a
ValueError, for one that is no saved map, damaged or of a newer version. Releases the GIL.)";

constexpr const char* kToBytesDoc =
    R"(The map as bytes, without what MRPT's programs want: the buffer of Map::save in C++.

exact: as for save().

Releases the GIL.)";

constexpr const char* kFromBytesDoc =
    R"(A map from the bytes of to_bytes(), or from the content of a `.hgmm` file.

data: bytes, or another contiguous buffer.

Raises FormatError, which is a ValueError. Releases the GIL.)";

using Bytes = std::vector<std::uint8_t>;

Encoding encodingOf(bool exact) {
    return exact ? Encoding::exact : Encoding::compact;
}

py::bytes toPython(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// From what a file holds.
Map mapFrom(Bytes bytes) {
    if (isGzip(bytes)) bytes = unwrapped(gunzipped(bytes));
    return Map::load(bytes.data(), bytes.size());
}

py::bytes toBytes(const SharedMap& map, bool exact) {
    return toPython(map.read([&](const Map& m) { return m.save(encodingOf(exact)); }));
}

std::unique_ptr<SharedMap> fromBytes(const py::buffer& data) {
    const py::buffer_info info = data.request();
    if (info.ndim != 1 || (info.size > 1 && info.strides[0] != info.itemsize))
        throw py::value_error("data: expected a contiguous buffer of one dimension");
    const auto* first = static_cast<const std::uint8_t*>(info.ptr);
    Bytes bytes(first, first + info.size * info.itemsize);
    const py::gil_scoped_release noGil;
    return std::make_unique<SharedMap>(mapFrom(std::move(bytes)));
}

void save(const SharedMap& map, const std::filesystem::path& file, bool exact) {
    map.read(
        [&](const Map& m) { writeFile(file, gzipped(wrapped(m, encodingOf(exact)))); });
}

std::unique_ptr<SharedMap> load(const std::filesystem::path& file) {
    const py::gil_scoped_release noGil;
    try {
        return std::make_unique<SharedMap>(mapFrom(readFile(file)));
    } catch (const FormatError& e) {
        throw FormatError(file.string() + ": " + e.what());
    }
}

std::unique_ptr<SharedMap> copy(const SharedMap& map) {
    return std::make_unique<SharedMap>(map.read([](const Map& m) { return m; }));
}

}  // namespace

void bindSaving(MapClass& map) {
    using namespace py::literals;
    map.def("save", &save, "file"_a, "exact"_a = false, kSaveDoc);
    map.def_static("load", &load, "file"_a, kLoadDoc);
    map.def("to_bytes", &toBytes, "exact"_a = false, kToBytesDoc);
    map.def_static("from_bytes", &fromBytes, "data"_a, kFromBytesDoc);
    map.def("copy", &copy, "A map of its own with the same content.");
    map.def("__copy__", &copy);
    map.def("__deepcopy__", [](const SharedMap& m, const py::dict&) { return copy(m); });
    map.def(py::pickle([](const SharedMap& m) { return toBytes(m, true); },
                       [](const py::bytes& state) { return fromBytes(state); }));
    map.def(
        "__eq__",
        [](const SharedMap& a, const SharedMap& b) {
            return a.readWith(b, [](const Map& x, const Map& y) { return x == y; });
        },
        py::is_operator(), "Same options, origin and components, bit for bit.");
}

}  // namespace hgmm::python
