#include "options/option_fields.h"

#include <mrpt/config/CConfigFileBase.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "options/warnings.h"

namespace hgmm::mrpt_bridge {

namespace {

std::string trimmed(std::string text) {
    text.erase(text.find_last_not_of(" \t\r") + 1);
    text.erase(0, text.find_first_not_of(" \t"));
    return text;
}

/// Whether the whole text is a number of this type, in the C locale.
template <typename Number>
bool parse(const std::string& text, Number& number) {
    const char *begin = text.data(), *end = begin + text.size();
    if (begin != end && *begin == '+') ++begin;
    const auto result = std::from_chars(begin, end, number);
    return begin != end && result.ec == std::errc() && result.ptr == end;
}

bool parse(std::string text, bool& value) {
    text = lowerCase(text);
    value = text == "true" || text == "yes" || text == "1";
    return value || text == "false" || text == "no" || text == "0";
}

bool parse(const std::string& text, std::string& value) {
    value = text;
    return true;
}

bool parse(const std::string& text, Names& names) {
    names.clear();
    if (text.empty()) return true;
    std::istringstream rest(text + ",");
    for (std::string name; std::getline(rest, name, ',');) {
        name = trimmed(name);
        if (name.empty()) return false;
        if (equalsIgnoringCase(name, "rgb"))
            names.insert(names.end(), {"r", "g", "b"});
        else
            names.push_back(name);
    }
    return true;
}

const char* expected(const OptionField& field) {
    static constexpr const char* names[] = {"a number", "a whole number", "true or false",
                                            "a text",
                                            "names separated by commas, as rgb, intensity"};
    return names[field.member.index()];
}

}  // namespace

OptionFields fieldsOf(mrpt::maps::CHGMMOccupancyMap::TInsertionOptions& options) {
    OptionFields fields;
    forEachOption(options.params, [&](const OptionRow& row, auto& field) {
        fields.push_back({&row, &field});
    });
    for (const OptionField& field : fieldsOf(options.reading)) fields.push_back(field);
    return fields;
}

double numberOf(const OptionField& field) {
    if (const auto* real = std::get_if<double*>(&field.member)) return **real;
    if (const auto* flag = std::get_if<bool*>(&field.member)) return **flag ? 1 : 0;
    return *std::get<int*>(field.member);
}

void setNumber(const OptionField& field, double value) {
    if (const auto* real = std::get_if<double*>(&field.member)) {
        **real = value;
        return;
    }
    const double whole = std::isnan(value) ? 0.0 : std::clamp(std::round(value), -2e9, 2e9);
    if (const auto* flag = std::get_if<bool*>(&field.member))
        **flag = whole != 0;
    else
        *std::get<int*>(field.member) = static_cast<int>(whole);
}

std::string textOf(const OptionField& field) {
    if (const auto* text = std::get_if<std::string*>(&field.member)) return **text;
    if (const auto* names = std::get_if<Names*>(&field.member)) return listed(**names);
    if (const auto* flag = std::get_if<bool*>(&field.member))
        return **flag ? "true" : "false";
    return numberText(numberOf(field));
}

void setText(const OptionField& field, const std::string& text, const std::string& key) {
    if (std::visit([&](auto* member) { return parse(text, *member); }, field.member))
        return;
    throw std::invalid_argument(key + " = '" + text + "': must be " + expected(field));
}

void writeSection(const OptionFields& fields, mrpt::config::CConfigFileBase& target,
                  const std::string& section) {
    for (const OptionField& field : fields)
        target.write(section, field.row->name, textOf(field));
}

void print(const OptionFields& fields, const std::string& title, std::ostream& out) {
    out << "[" << title << "]\n";
    for (const OptionField& field : fields)
        out << field.row->name << " = " << textOf(field) << "\n";
    out << "\n";
}

}  // namespace hgmm::mrpt_bridge
