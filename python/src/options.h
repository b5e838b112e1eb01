#pragma once
#include <pybind11/pybind11.h>

#include "hgmm/params.h"

/// Options of a map as keywords: the names of docs/options.md.
namespace hgmm::python {

/// Options that are not given follow resolution_m as in a configuration. Throws TypeError
/// for a name that there is not, naming the nearest, or a value of the wrong type;
/// ValueError for one out of range.
MapParams paramsFrom(const pybind11::kwargs& options);

/// All options by name.
pybind11::dict optionsOf(const MapParams& params);

}  // namespace hgmm::python
