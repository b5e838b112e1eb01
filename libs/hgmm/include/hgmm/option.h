#pragma once
#include <functional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "hgmm/export.h"

/// Options as tables: one row a field of a parameter struct. From the rows come validation,
/// comparison, saved maps, configuration files and docs/options.md.
namespace hgmm {

/// A list of names.
using Names = std::vector<std::string>;

/// What a table says about a field. The default is that of the struct.
struct OptionRow {
    const char* name;  ///< of the field, of the key in files; unique over a struct's tables
    const char* unit;  ///< "m", "1", "count"; empty for texts and switches
    double low, high;  ///< range of a number, ends included
    const char* doc;   ///< one line
    bool isBasic = false;              ///< whether most users meet it
    bool mayBeZero = false;            ///< 0 is allowed besides the range
    bool scales = false;               ///< a length that follows resolution_m
    const char* atLeast = nullptr;     ///< row of the same struct that bounds it from below
    const char* atMost = nullptr;      ///< likewise, from above
    const char* formerName = nullptr;  ///< key in older files, accepted for ever

    /// Whether a key in a saved map means this row.
    bool isNamed(const std::string& key) const {
        return key == name || (formerName && key == formerName);
    }
};

/// A row with its field of `Struct`.
template <typename Struct>
struct Option : OptionRow {
    using Member = std::variant<double Struct::*, int Struct::*, bool Struct::*,
                                std::string Struct::*, Names Struct::*>;
    Member member;

    Option(const char* name_, Member m, const char* unit_, double low_, double high_,
           const char* doc_)
        : OptionRow{name_, unit_, low_, high_, doc_}, member(m) {}
    /// A text or a switch: no unit and no range.
    Option(const char* name_, Member m, const char* doc_)
        : OptionRow{name_, "", 0, 1, doc_}, member(m) {}

    Option basic() const { return with(&OptionRow::isBasic, true); }
    Option orZero() const { return with(&OptionRow::mayBeZero, true); }
    Option followsResolution() const { return with(&OptionRow::scales, true); }
    Option notBelow(const char* row) const { return with(&OptionRow::atLeast, row); }
    Option notAbove(const char* row) const { return with(&OptionRow::atMost, row); }
    Option formerly(const char* key) const { return with(&OptionRow::formerName, key); }

 private:
    template <typename T>
    Option with(T OptionRow::*property, T value) const {
        Option copy = *this;
        copy.*property = value;
        return copy;
    }
};

/// The table of a struct; `Struct::options()` returns it.
template <typename Struct>
using OptionTable = std::vector<Option<Struct>>;

/// An option that is no more, and why a value other than 0 cannot be had. Files that hold
/// 0 are read.
struct RetiredOption {
    const char* name;
    const char* reason;
};

/// Calls visit(row, field) for each row of the struct's own table; fields are double, int,
/// bool, std::string or Names, const if the struct is.
template <typename Struct, typename Visitor>
void forEachRow(Struct& s, Visitor&& visit) {
    for (const auto& row : Struct::options())
        std::visit([&](auto member) { visit(row, s.*member); }, row.member);
}

/// Whether a field is a number that has a unit and a range.
template <typename Field>
constexpr bool isNumber =
    std::is_same_v<std::decay_t<Field>, double> || std::is_same_v<std::decay_t<Field>, int>;

/// Throws std::invalid_argument "name = value: must be in [low, high]" unless it is; NaN
/// never is.
HGMM_EXPORT void requireInRange(const char* name, double value, double low, double high);

/// Which options somebody set, by name.
using WasSet = std::function<bool(const std::string& name)>;

/// A row and the number that its field holds.
struct OptionValue {
    const OptionRow* row;
    double value;
};
/// Throws std::invalid_argument "name = value: must be in [low, high]" for the first value
/// out of the range of its row, or of what another row of the list allows it. Of two that
/// do not fit together, names one that was set, the first if both or none were.
HGMM_EXPORT void requireInRange(const std::vector<OptionValue>& values,
                                const WasSet& wasSet = nullptr);

/// The number as files and messages hold it: the shortest text that reads back the same.
HGMM_EXPORT std::string numberText(double number);

/// As above, for the numbers of a struct's own table.
template <typename Struct>
void requireOptionsInRange(const Struct& s, const WasSet& wasSet = nullptr) {
    std::vector<OptionValue> values;
    forEachRow(s, [&](const OptionRow& row, const auto& field) {
        if constexpr (isNumber<decltype(field)>)
            values.push_back({&row, static_cast<double>(field)});
    });
    requireInRange(values, wasSet);
}

/// Whether all fields of the struct's own table are equal.
template <typename Struct>
bool sameOptions(const Struct& a, const Struct& b) {
    for (const auto& row : Struct::options())
        if (!std::visit([&](auto member) { return a.*member == b.*member; }, row.member))
            return false;
    return true;
}

}  // namespace hgmm
