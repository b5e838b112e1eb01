#include "option_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <numeric>
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

/// A value without the comment that may follow it; MRPT itself strips only "//".
std::string withoutComment(const std::string& text) {
    std::string value = text.substr(0, text.find_first_of(";#"));
    value.erase(value.find_last_not_of(" \t\r") + 1);
    value.erase(0, value.find_first_not_of(" \t"));
    return value;
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

const char* expected(const OptionField& field) {
    static constexpr const char* names[] = {"a number", "a whole number", "true or false"};
    return names[field.member.index()];
}

void readField(const OptionField& field, const std::string& text,
               const std::string& section) {
    if (std::visit([&](auto* member) { return parse(text, *member); }, field.member))
        return;
    throw std::invalid_argument("[" + section + "] " + field.name + " = '" + text +
                                "': must be " + expected(field));
}

std::string toText(double number) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), number).ptr;
    return std::string(text, end);
}

std::string toText(const OptionField& field) {
    if (const auto* flag = std::get_if<bool*>(&field.member))
        return **flag ? "true" : "false";
    return toText(numberOf(field));
}

}  // namespace

double numberOf(const OptionField& field) {
    return std::visit([](const auto* member) { return static_cast<double>(*member); },
                      field.member);
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
        target.write(section, field.name, toText(field));
}

void print(const OptionFields& fields, const std::string& title, std::ostream& out) {
    out << "[" << title << "]\n";
    for (const OptionField& field : fields)
        out << field.name << " = " << toText(field) << "\n";
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
