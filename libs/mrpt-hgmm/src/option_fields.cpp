#include "option_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace hgmm::mrpt_bridge {

namespace {

/// Number of single-character edits between two names, case ignored.
std::size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                              std::tolower(static_cast<unsigned char>(b[j - 1]));
            const std::size_t replaced = diagonal + (same ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

std::string trimmed(std::string text) {
    text.erase(text.find_last_not_of(" \t\r") + 1);
    text.erase(0, text.find_first_not_of(" \t"));
    return text;
}

/// A value without the comment that may follow it; MRPT itself strips only "//", and not
/// where there is no value.
std::string withoutComment(const std::string& text) {
    return trimmed(text.substr(0, std::min(text.find_first_of(";#"), text.find("//"))));
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
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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
        if (name == "rgb")
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

void readField(const OptionField& field, const std::string& text,
               const std::string& section) {
    try {
        setText(field, text);
    } catch (const std::invalid_argument& e) {
        throw std::invalid_argument("[" + section + "] " + e.what());
    }
}

std::string toText(double number) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), number).ptr;
    return std::string(text, end);
}

std::string toText(const Names& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace

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
    if (const auto* names = std::get_if<Names*>(&field.member)) return toText(**names);
    if (const auto* flag = std::get_if<bool*>(&field.member))
        return **flag ? "true" : "false";
    return toText(numberOf(field));
}

void setText(const OptionField& field, const std::string& text) {
    if (std::visit([&](auto* member) { return parse(text, *member); }, field.member))
        return;
    throw std::invalid_argument(std::string(field.name) + " = '" + text + "': must be " +
                                expected(field));
}

void readSection(const OptionFields& fields, const mrpt::config::CConfigFileBase& source,
                 const std::string& section) {
    std::vector<std::string> keys, known;
    source.getAllKeys(section, keys);
    for (const OptionField& field : fields) {
        known.emplace_back(field.name);
        if (source.keyExists(section, field.name))
            readField(field, withoutComment(source.read_string(section, field.name, "")),
                      section);
    }
    warnOfUnknown(keys, known, "key", "section [" + section + "]");
}

void writeSection(const OptionFields& fields, mrpt::config::CConfigFileBase& target,
                  const std::string& section) {
    for (const OptionField& field : fields)
        target.write(section, field.name, textOf(field));
}

void print(const OptionFields& fields, const std::string& title, std::ostream& out) {
    out << "[" << title << "]\n";
    for (const OptionField& field : fields)
        out << field.name << " = " << textOf(field) << "\n";
    out << "\n";
}

void warnOfUnknown(const std::vector<std::string>& names,
                   const std::vector<std::string>& known, const std::string& what,
                   const std::string& where) {
    for (const std::string& name : names) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        const auto nearest = std::min_element(
            known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
                return editDistance(name, a) < editDistance(name, b);
            });
        std::cerr << "[hgmm] warning: unknown " << what << " '" << name << "' in " << where
                  << " is ignored; did you mean '" << *nearest << "'?" << std::endl;
    }
}

}  // namespace hgmm::mrpt_bridge
