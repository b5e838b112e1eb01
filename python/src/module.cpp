#include <pybind11/pybind11.h>

#include <filesystem>

#include "shared_map.h"

namespace py = pybind11;
using namespace hgmm::python;

namespace {

constexpr const char* kMapDoc =
    R"(A hierarchy of Gaussian mixtures over what range sensors saw, with the free space that their
rays passed (thesis chapters 3 and 4), updated scan by scan.

Points are arrays of shape (N, 3) in the map frame [m], unless a name says otherwise. float64
in C order is read where it is; other numbers are converted. Level 0 is the finest.

Threads can share a map: one that changes it waits for those that read it. All calls that take
long release the GIL.)";

/// OSError, with the number that makes it a FileNotFoundError and so on.
void translateFileErrors(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const std::filesystem::filesystem_error& e) {
        const py::object error = py::reinterpret_borrow<py::object>(PyExc_OSError)(
            e.code().value(), e.code().message(), e.path1().string());
        PyErr_SetObject(PyExc_OSError, error.ptr());
    }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
    module.doc() = "What is compiled of hgmm; import hgmm instead.";
    module.attr("__version__") = HGMM_VERSION;
    py::register_exception_translator(translateFileErrors);
    const py::object formatError =
        py::register_exception<hgmm::FormatError>(module, "FormatError", PyExc_ValueError);
    formatError.attr("__doc__") =
        "A saved map that cannot be used: truncated, damaged, foreign, or of a newer "
        "version.";
    formatError.attr("__module__") = "hgmm";

    MapClass map(module, "Map", kMapDoc);
    map.attr("__module__") = "hgmm";
    bindBuilding(map);
    bindRegistration(map);
    bindQueries(map);
    bindContents(map);
    bindSaving(map);
}
