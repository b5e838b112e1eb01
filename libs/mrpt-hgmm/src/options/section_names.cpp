#include "options/section_names.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

#include "options/option_tables.h"
#include "options/warnings.h"

namespace hgmm::mrpt_bridge {

namespace {

using mrpt::config::CConfigFileBase;

/// Names of the map's class in configurations.
constexpr const char* kKinds[] = {"hgmmMap", "mrpt::maps::CHGMMOccupancyMap"};

/// "<parent>_<kind>_", as MRPT begins the names of maps' sections.
struct Prefix {
    std::string parent, kind;

    std::string common() const { return parent + "_" + kind; }
};

bool allDigits(const std::string& text) {
    return !text.empty() && text.size() < 9 &&
           std::all_of(text.begin(), text.end(),
                       [](unsigned char c) { return std::isdigit(c); });
}

std::optional<Prefix> prefixOf(const std::string& prefix) {
    const std::size_t last = prefix.rfind('_');
    if (last == std::string::npos || !allDigits(prefix.substr(last + 1)))
        return std::nullopt;
    for (const std::string kind : kKinds) {
        const std::string end = "_" + kind;
        if (last < end.size() || prefix.compare(last - end.size(), end.size(), end) != 0)
            continue;
        return Prefix{prefix.substr(0, last - end.size()), kind};
    }
    return std::nullopt;
}

bool startsWith(const std::string& text, const std::string& start) {
    return equalsIgnoringCase(text.substr(0, start.size()), start);
}

/// The end of a section of a map, "insertOpts", that a name has; empty if it has none.
std::string endOf(const std::string& section) {
    for (const SectionRows& known : allSections()) {
        const std::string end = std::string("_") + known.section;
        if (section.size() >= end.size() &&
            equalsIgnoringCase(section.substr(section.size() - end.size()), end))
            return known.section;
    }
    return {};
}

std::string twoDigits(unsigned long number) {
    return (number < 10 ? "0" : "") + std::to_string(number);
}

void warnOfSection(const std::string& section, const std::string& meant) {
    warn("unknown section '" + section +
         "' in the configuration is ignored; did you mean '" + meant + "'?");
}

/// The section that was probably meant by one that starts with "<map's prefix>".
std::string nearestSection(const std::string& section, const std::string& prefix) {
    std::vector<std::string> known;
    for (const SectionRows& rows : allSections())
        known.push_back(prefix + "_" + rows.section);
    return nearestName(section, known);
}

/// The number in the end of a section's name; 0 if there is none.
unsigned long numberOf(const std::string& end) {
    const std::size_t from = std::min(end.find_first_of("0123456789"), end.size());
    const std::string digits =
        end.substr(from, end.find_first_not_of("0123456789", from) - from);
    return allDigits(digits) ? std::stoul(digits) : 0;
}

/// Checks a section that starts with "<parent>_<kind>".
void checkOwnSection(const CConfigFileBase& source, const Prefix& first,
                     const std::string& section) {
    const std::string key = first.kind + "_count";
    const bool isCounted = source.keyExists(first.parent, key);
    const int count = isCounted ? source.read_int(first.parent, key, 0) : 1;
    const unsigned long number = numberOf(section.substr(first.common().size()));
    const bool isThere = !isCounted || static_cast<long>(number) < count;
    if (equalsIgnoringCase(
            section, first.common() + "_" + twoDigits(number) + "_" + endOf(section))) {
        if (!isThere)
            warn("section [" + section + "] is ignored: there is no map " +
                 twoDigits(number) + ", as [" + first.parent + "] has " + key + " = " +
                 std::to_string(count) + " and maps are numbered from 00");
        return;
    }
    warnOfSection(section, nearestSection(section, first.common() + "_" +
                                                       twoDigits(isThere ? number : 0)));
}

/// Checks a section that names our kind of map behind another parent, which may have a
/// count of its own.
void checkForeignSection(const CConfigFileBase& source, const Prefix& first,
                         const std::string& section) {
    const std::size_t at = lowerCase(section).rfind(lowerCase(first.kind) + "_");
    const std::string end = endOf(section);
    if (at == std::string::npos || end.empty()) return;
    const std::string parent = at == 0 ? "" : section.substr(0, at - 1);
    if (!parent.empty() && source.keyExists(parent, first.kind + "_count")) return;
    warn("section [" + section + "] is ignored: no section [" + parent + "] has " +
         first.kind + "_count; did you mean '" + first.common() + "_00_" + end + "'?");
}

/// Options beside "<kind>_count", where the user takes them for the map's.
void checkParentKeys(const CConfigFileBase& source, const Prefix& first) {
    std::vector<std::string> keys;
    source.getAllKeys(first.parent, keys);
    for (const std::string& key : keys) {
        std::string where;
        for (const SectionRows& section : allSections())
            for (const OptionRow* row : section.rows)
                if (equalsIgnoringCase(key, row->name) ||
                    (row->formerName && equalsIgnoringCase(key, row->formerName)))
                    where += (where.empty() ? "[" : " or [") + first.common() + "_00_" +
                             section.section + "]";
        if (!where.empty())
            warn("key '" + key + "' in section [" + first.parent +
                 "] is ignored; it belongs to section " + where);
    }
}

}  // namespace

std::string siblingSection(const std::string& section, const std::string& end) {
    const std::string own = endOf(section);
    if (own.empty()) return "..._" + end;
    return section.substr(0, section.size() - own.size()) + end;
}

void warnOfUnreadSections(const CConfigFileBase& source, const std::string& prefix) {
    std::vector<std::string> sections;
    source.getAllSections(sections);
    const std::optional<Prefix> first = prefixOf(prefix);
    if (!first) {
        for (const std::string& section : sections)
            if (startsWith(section, prefix + "_") && endOf(section).empty())
                warnOfSection(section, nearestSection(section, prefix));
        return;
    }
    checkParentKeys(source, *first);
    for (const std::string& section : sections)
        if (startsWith(section, first->common()))
            checkOwnSection(source, *first, section);
        else
            checkForeignSection(source, *first, section);
}

}  // namespace hgmm::mrpt_bridge
