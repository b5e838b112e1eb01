#include "compare.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace equality {
namespace {

constexpr std::size_t kMostReported = 8;  // [sections]

template <typename T>
T numberAt(const Section& section, std::size_t i) {
    T value;
    std::memcpy(&value, section.bytes.data() + i * sizeof value, sizeof value);
    return value;
}

std::string print(const char* format, double value) {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string textAt(const Section& section, std::size_t i) {
    switch (section.number) {
        case Number::byte:
            return std::to_string(section.bytes[i]);
        case Number::count:
            return std::to_string(numberAt<std::uint64_t>(section, i));
        case Number::single:
            return print("%.9g", static_cast<double>(numberAt<float>(section, i)));
        case Number::real:
            return print("%.17g", numberAt<double>(section, i));
    }
    return {};
}

/// Name of number i: "mean x of component 17".
std::string entity(const Section& section, std::size_t i) {
    const std::size_t width = section.columns.size();
    return section.columns[i % width] + " of " + section.row + " " +
           std::to_string(i / width);
}

bool sameShape(const Section& a, const Section& b) {
    return a.kind == b.kind && a.row == b.row && a.columns == b.columns &&
           a.number == b.number;
}

/// What differs between two sections of one name; empty if nothing does.
std::string difference(const Section& base, const Section& present) {
    if (!sameShape(base, present)) return base.name + ": columns differ";
    const std::size_t size = sizeOf(base.number);
    const std::size_t n = std::min(base.numbers(), present.numbers());
    std::size_t first = n, count = 0;
    for (std::size_t i = n; i-- > 0;) {
        if (!std::memcmp(&base.bytes[i * size], &present.bytes[i * size], size)) continue;
        first = i;
        ++count;
    }
    std::string text;
    if (base.numbers() != present.numbers())
        text = ": " + std::to_string(base.rows()) + " rows are " +
               std::to_string(present.rows());
    if (first < n)
        text += ": " + entity(base, first) + ": " + textAt(base, first) + " is " +
                textAt(present, first) + "; " + std::to_string(count) + " of " +
                std::to_string(n) + " numbers differ";
    return text.empty() ? text : base.name + text;
}

std::vector<std::string> differences(const Dump& base, const Dump& present) {
    std::vector<std::string> found;
    for (const Section& section : base.sections()) {
        const Section* other = present.find(section.name);
        const std::string text = other ? difference(section, *other)
                                       : section.name + ": is missing in the present tree";
        if (!text.empty()) found.push_back(text);
    }
    for (const Section& section : present.sections())
        if (!base.find(section.name))
            found.push_back(section.name + ": is missing in the base tree");
    return found;
}

/// Says how much a dump holds.
std::string extent(const Dump& dump) {
    std::size_t components = 0, arrays = 0, answers = 0, numbers = 0;
    for (const Section& section : dump.sections()) {
        if (section.kind == Kind::answers) answers += section.rows();
        if (section.kind == Kind::answers) numbers += section.numbers();
        if (section.kind != Kind::components) continue;
        arrays += section.columns.size();
        if (section.row == "component") components += section.rows();
    }
    const Section* scans = dump.find("scans");
    return (scans ? textAt(*scans, 1) + " of " + textAt(*scans, 0) + " scans, " : "") +
           std::to_string(components) + " components of all levels in " +
           std::to_string(arrays) + " arrays, " + std::to_string(answers) + " answers of " +
           std::to_string(numbers) + " numbers";
}

template <typename Bits>
void addOne(std::uint8_t* bytes) {
    Bits bits;
    std::memcpy(&bits, bytes, sizeof bits);
    ++bits;
    std::memcpy(bytes, &bits, sizeof bits);
}

}  // namespace

bool compare(const std::string& recording, const Dump& base, const Dump& present) {
    const std::vector<std::string> found = differences(base, present);
    const bool equal = found.empty() && !base.sections().empty();
    std::printf("%-28s %s: %s\n", recording.c_str(), equal ? "equal" : "DIFFERENT",
                extent(base).c_str());
    for (std::size_t i = 0; i < std::min(found.size(), kMostReported); ++i)
        std::printf("    %s\n", found[i].c_str());
    if (found.size() > kMostReported)
        std::printf("    and %zu more sections\n", found.size() - kMostReported);
    return equal;
}

void plant(Dump& dump, const std::string& section, const std::string& column,
           std::size_t row) {
    Section* target = dump.find(section);
    if (!target) throw std::runtime_error(section + ": there is no such section");
    const auto at = std::find(target->columns.begin(), target->columns.end(), column);
    if (at == target->columns.end() || row >= target->rows())
        throw std::runtime_error(section + ": has no such column or row");
    const auto place = static_cast<std::size_t>(at - target->columns.begin());
    const std::size_t i = row * target->columns.size() + place;
    std::uint8_t* bytes = &target->bytes[i * sizeOf(target->number)];
    if (target->number == Number::single)
        addOne<std::uint32_t>(bytes);
    else if (target->number == Number::real)
        addOne<std::uint64_t>(bytes);
    else
        throw std::runtime_error(section + ": holds no floats");
}

}  // namespace equality
