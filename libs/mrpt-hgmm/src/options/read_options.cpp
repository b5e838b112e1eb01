#include "options/read_options.h"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <stdexcept>

#include "hgmm/params.h"
#include "options/section_names.h"
#include "options/warnings.h"

namespace hgmm::mrpt_bridge {

namespace {

using mrpt::config::CConfigFileBase;

/// The value of a key without the comment that may follow it; MRPT itself strips only "//",
/// and not where there is no value.
std::string valueOf(const CConfigFileBase& source, const std::string& section,
                    const std::string& key) {
    const std::string text = source.read_string(section, key, "");
    std::string value = text.substr(0, std::min(text.find_first_of(";#"), text.find("//")));
    value.erase(value.find_last_not_of(" \t\r") + 1);
    value.erase(0, value.find_first_not_of(" \t"));
    return value;
}

std::vector<std::string> keysOf(const CConfigFileBase& source, const std::string& section) {
    std::vector<std::string> keys;
    source.getAllKeys(section, keys);
    return keys;
}

/// The one of `keys` that is a name as MRPT reads it, whatever its case; null if none is.
const std::string* find(const std::vector<std::string>& keys, const char* name) {
    const auto at = std::find_if(keys.begin(), keys.end(), [&](const std::string& key) {
        return name && equalsIgnoringCase(key, name);
    });
    return at == keys.end() ? nullptr : &*at;
}

/// Names of rows that a section sets, and the keys by which it does.
using WrittenKeys = std::map<std::string, std::string>;

WrittenKeys writtenKeys(const OptionFields& fields, const std::vector<std::string>& keys,
                        const std::string& section) {
    WrittenKeys written;
    for (const OptionField& field : fields) {
        const OptionRow& row = *field.row;
        const std::string* key = find(keys, row.name);
        const std::string* former = find(keys, row.formerName);
        if (key && former)
            warn("section [" + section + "] has '" + *key + "' and '" + *former +
                 "', a former name of the same option: '" + *former + "' is ignored");
        if (key && *key != row.name)
            warn("key '" + *key + "' in section [" + section + "] is read as '" + row.name +
                 "'");
        if (key || former) written[row.name] = key ? *key : *former;
    }
    return written;
}

/// Throws if a field is out of range, by the keys that the section has.
void requireFieldsInRange(const OptionFields& fields, const WrittenKeys& written) {
    std::deque<OptionRow> rows;  // named as in the section; addresses stay
    std::vector<OptionValue> values;
    for (const OptionField& field : fields) {
        if (!field.isRanged()) continue;
        OptionRow& row = rows.emplace_back(*field.row);
        const auto key = written.find(row.name);
        if (key != written.end() && row.formerName && find({key->second}, row.formerName))
            row.name = row.formerName;
        values.push_back({&row, numberOf(field)});
    }
    requireInRange(values,
                   [&](const std::string& name) { return written.count(name) > 0; });
}

void refuseRetired(const CConfigFileBase& source, const std::string& section,
                   const std::vector<std::string>& keys) {
    for (const RetiredOption& retired : retiredOptions())
        if (const std::string* key = find(keys, retired.name))
            if (const std::string value = valueOf(source, section, *key);
                value.find_first_not_of("0.+-") != std::string::npos)
                throw std::invalid_argument(*key + " = " + value + ": " + retired.reason);
}

/// Sections of the same map that have an option of this name.
std::vector<std::string> sectionsWith(const std::string& key, const std::string& section) {
    std::vector<std::string> found;
    for (const SectionRows& other : allSections())
        for (const OptionRow* row : other.rows)
            if (find({key}, row->name) || find({key}, row->formerName))
                found.push_back(siblingSection(section, other.section));
    return found;
}

}  // namespace

void warnOfUnknownKeys(const OptionFields& fields, const CConfigFileBase& source,
                       const std::string& section) {
    std::vector<std::string> names;
    for (const OptionField& field : fields) names.emplace_back(field.row->name);
    for (const std::string& key : keysOf(source, section)) {
        const bool isKnown =
            std::any_of(fields.begin(), fields.end(), [&](const OptionField& field) {
                return find({key}, field.row->name) || find({key}, field.row->formerName);
            });
        const auto& retired = retiredOptions();
        if (isKnown ||
            std::any_of(retired.begin(), retired.end(),
                        [&](const RetiredOption& r) { return find({key}, r.name); }))
            continue;
        const std::vector<std::string> others = sectionsWith(key, section);
        if (others.empty())
            warn("unknown key '" + key + "' in section [" + section +
                 "] is ignored; did you mean '" + nearestName(key, names) + "'?");
        else
            warn("key '" + key + "' in section [" + section +
                 "] is ignored; it belongs to section [" + others.front() + "]");
    }
}

std::optional<double> numberIn(const CConfigFileBase& source, const std::string& section,
                               const std::string& name) {
    if (!source.keyExists(section, name)) return std::nullopt;
    double number = 0;
    const OptionRow row{name.c_str(), "", 0, 0, ""};
    setText({&row, &number}, valueOf(source, section, name), name);
    return number;
}

void readSection(const OptionFields& fields, const CConfigFileBase& source,
                 const std::string& section) {
    const std::vector<std::string> keys = keysOf(source, section);
    refuseRetired(source, section, keys);
    const WrittenKeys written = writtenKeys(fields, keys, section);
    for (const OptionField& field : fields)
        if (const auto key = written.find(field.row->name); key != written.end())
            setText(field, valueOf(source, section, key->second), key->second);
    requireFieldsInRange(fields, written);
    warnOfUnknownKeys(fields, source, section);
}

}  // namespace hgmm::mrpt_bridge
