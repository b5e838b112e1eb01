#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

#include "hgmm/option.h"
#include "options/option_tables.h"

/// Rows of option tables with the fields of one object, as texts and numbers.
namespace hgmm::mrpt_bridge {

struct OptionField {
    const OptionRow* row;
    std::variant<double*, int*, bool*, std::string*, Names*> member;

    bool isText() const {
        return std::holds_alternative<std::string*>(member) ||
               std::holds_alternative<Names*>(member);
    }
    bool isRanged() const {
        return std::holds_alternative<double*>(member) ||
               std::holds_alternative<int*>(member);
    }
};
using OptionFields = std::vector<OptionField>;

/// The fields of the tables of a struct, in their order.
template <typename Struct>
OptionFields fieldsOf(Struct& options) {
    OptionFields fields;
    forEachRow(options, [&](const OptionRow& row, auto& field) {
        fields.push_back({&row, &field});
    });
    return fields;
}
OptionFields fieldsOf(mrpt::maps::CHGMMOccupancyMap::TInsertionOptions& options);

/// The value of a field that is no text as a number (a bool is 0 or 1), and back; int and
/// bool members take the nearest.
double numberOf(const OptionField& field);
void setNumber(const OptionField& field, double value);

/// The value as a configuration file holds it.
std::string textOf(const OptionField& field);
/// Sets the value. Throws std::invalid_argument, saying what `key` must be, for a text that
/// is none.
void setText(const OptionField& field, const std::string& text, const std::string& key);

/// Writes all keys of a section.
void writeSection(const OptionFields& fields, mrpt::config::CConfigFileBase& target,
                  const std::string& section);
void print(const OptionFields& fields, const std::string& title, std::ostream& out);

}  // namespace hgmm::mrpt_bridge
