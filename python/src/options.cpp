#include "options.h"

#include <pybind11/stl.h>

#include <cmath>
#include <string>
#include <vector>

namespace py = pybind11;

namespace hgmm::python {

namespace {

[[noreturn]] void refuseName(const std::string& name) {
    const MapParams params;
    py::list names;
    std::string meant;
    forEachOption(params, [&](const OptionRow& row, const auto&) {
        names.append(row.name);
        if (row.isNamed(name)) meant = row.name;
    });
    if (meant.empty())
        meant = py::module_::import("difflib")
                    .attr("get_close_matches")(name, names, 1, 0.0)[py::int_(0)]
                    .cast<std::string>();
    throw py::type_error("there is no option '" + name + "'; did you mean '" + meant +
                         "'?");
}

[[noreturn]] void refuseValue(const std::string& name, const py::handle& value,
                              const char* expected) {
    throw py::type_error(name + " = " + py::repr(value).cast<std::string>() + ": must be " +
                         expected);
}

void set(double& field, const std::string& name, const py::handle& value) {
    if (py::isinstance<py::str>(value)) refuseValue(name, value, "a number");
    const double number = PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred()) {
        PyErr_Clear();
        refuseValue(name, value, "a number");
    }
    field = number;
}

void set(int& field, const std::string& name, const py::handle& value) {
    double number = 0;
    set(number, name, value);
    if (number != std::round(number) || std::abs(number) > 2e9)
        refuseValue(name, value, "a whole number");
    field = static_cast<int>(number);
}

void set(Names& field, const std::string& name, const py::handle& value) {
    constexpr const char* expected =
        "names: a list, or a text with commas, as 'rgb, intensity'";
    py::object list = py::reinterpret_borrow<py::object>(value);
    if (py::isinstance<py::str>(value)) list = list.attr("split")(",");
    if (!py::isinstance<py::list>(list) && !py::isinstance<py::tuple>(list))
        refuseValue(name, value, expected);
    field.clear();
    for (const py::handle& item : list) {
        if (!py::isinstance<py::str>(item)) refuseValue(name, value, expected);
        const auto text = item.attr("strip")().cast<std::string>();
        if (text.empty()) continue;
        if (text == "rgb")
            field.insert(field.end(), {"r", "g", "b"});
        else
            field.push_back(text);
    }
}

/// Switches and texts: no option of the core's is one yet.
template <typename Field>
void set(Field& field, const std::string& name, const py::handle& value) {
    if (!py::isinstance<Field>(value)) refuseValue(name, value, "true or false, or a text");
    field = value.cast<Field>();
}

}  // namespace

MapParams paramsFrom(const py::kwargs& options) {
    MapParams params;
    if (options.contains("resolution_m")) {
        double resolution_m = 0;
        set(resolution_m, "resolution_m", options["resolution_m"]);
        params.setResolution(resolution_m);
    }
    std::size_t found = 0;
    std::vector<OptionValue> values;
    forEachOption(params, [&](const OptionRow& row, auto& field) {
        if (options.contains(row.name)) {
            set(field, row.name, options[row.name]);
            ++found;
        }
        if constexpr (isNumber<decltype(field)>)
            values.push_back({&row, static_cast<double>(field)});
    });
    if (found < options.size())
        for (const auto& [key, value] : options)
            if (!optionsOf(params).contains(key)) refuseName(key.cast<std::string>());
    requireInRange(values,
                   [&](const std::string& name) { return options.contains(name.c_str()); });
    params.validate();
    return params;
}

py::dict optionsOf(const MapParams& params) {
    py::dict options;
    forEachOption(params, [&](const OptionRow& row, const auto& field) {
        options[row.name] = field;
    });
    return options;
}

}  // namespace hgmm::python
