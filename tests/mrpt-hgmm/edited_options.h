#pragma once
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <map>
#include <ostream>
#include <string>
#include <type_traits>

/// Options with every value away from its default, so that a forgotten one shows.
namespace edited {

using mrpt::maps::CHGMMOccupancyMap;

/// A number or a text, to be compared and printed.
struct Value {
    Value() = default;
    Value(double n) : number(n) {}
    Value(const std::string& t) : text(t) {}

    bool operator==(const Value& o) const { return number == o.number && text == o.text; }
    bool operator!=(const Value& o) const { return !(*this == o); }

    double number = 0;
    std::string text;
};
inline std::ostream& operator<<(std::ostream& out, const Value& v) {
    return v.text.empty() ? out << v.number : out << v.text;
}
using Values = std::map<std::string, Value>;

/// Calls visit(row, field) for each option.
template <typename Visitor>
void visitAll(CHGMMOccupancyMap::TInsertionOptions& options, Visitor&& visit) {
    ::hgmm::forEachOption(options.params, visit);
    ::hgmm::forEachRow(options.reading, visit);
}
template <typename Options, typename Visitor>
void visitAll(Options& options, Visitor&& visit) {
    ::hgmm::forEachRow(options, visit);
}

template <typename Options>
Values values(Options options) {
    Values values;
    visitAll(options, [&](const ::hgmm::OptionRow& row, const auto& field) {
        using Field = std::decay_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, ::hgmm::Names>) {
            std::string& text = values[row.name].text;
            for (const std::string& name : field) text += name + ";";
        } else {
            values[row.name] = Value(field);
        }
    });
    return values;
}

/// Moves a field away from its value, within its range.
inline void change(const ::hgmm::OptionRow& row, int& field) {
    field += field + 1 <= row.high ? 1 : -1;
}
inline void change(const ::hgmm::OptionRow& row, double& field) {
    // Exact in binary, inside every range.
    field = field == 0.0 ? row.low + 0.25 : 0.875 * field;
}
inline void change(const ::hgmm::OptionRow&, bool& field) {
    field = !field;
}
inline void change(const ::hgmm::OptionRow&, std::string& field) {
    field = "water content";
}
inline void change(const ::hgmm::OptionRow&, ::hgmm::Names& field) {
    field = {"intensity", "water content"};
}

template <typename Options>
void change(Options& options) {
    visitAll(options,
             [](const ::hgmm::OptionRow& row, auto& field) { change(row, field); });
}
inline void change(CHGMMOccupancyMap& map) {
    change(map.insertionOptions);
    change(map.likelihoodOptions);
    change(map.renderOptions);
    map.insertionOptions.params.validate();
    map.insertionOptions.reading.validate();
    map.likelihoodOptions.validate();
    map.renderOptions.validate();
    map.genericMapParams.enableObservationInsertion = false;
    map.genericMapParams.enableSaveAs3DObject = false;
}

inline Values all(const CHGMMOccupancyMap& map) {
    Values all;
    const auto add = [&](const std::string& of, const Values& values) {
        for (const auto& [name, value] : values) all[of + " " + name] = value;
    };
    add("insertion", values(map.insertionOptions));
    add("likelihood", values(map.likelihoodOptions));
    add("render", values(map.renderOptions));
    all["insertion"] = map.genericMapParams.enableObservationInsertion;
    all["3D"] = map.genericMapParams.enableSaveAs3DObject;
    all["likelihood"] = map.genericMapParams.enableObservationLikelihood;
    return all;
}

}  // namespace edited
