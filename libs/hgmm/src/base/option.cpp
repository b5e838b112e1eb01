#include "hgmm/option.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace hgmm {

namespace {

std::string rangeOf(const OptionRow& row, double low, double high) {
    return std::string(row.mayBeZero ? "0 or in [" : "in [") + numberText(low) + ", " +
           numberText(high) + "]";
}

void requireAlone(const OptionValue& v) {
    if (v.value >= v.row->low && v.value <= v.row->high) return;
    if (v.row->mayBeZero && v.value == 0.0) return;
    throw std::invalid_argument(std::string(v.row->name) + " = " + numberText(v.value) +
                                ": must be " + rangeOf(*v.row, v.row->low, v.row->high));
}

/// Says that one of two values, of which `lower` must not be above `upper`, is wrong.
[[noreturn]] void refusePair(const OptionValue& lower, const OptionValue& upper,
                             bool blameUpper) {
    const OptionValue& wrong = blameUpper ? upper : lower;
    const OptionValue& other = blameUpper ? lower : upper;
    const std::string range =
        blameUpper
            ? rangeOf(*wrong.row, std::max(lower.value, wrong.row->low), wrong.row->high)
            : rangeOf(*wrong.row, wrong.row->low, std::min(upper.value, wrong.row->high));
    throw std::invalid_argument(std::string(wrong.row->name) + " = " +
                                numberText(wrong.value) + ": must be " + range + ", as " +
                                other.row->name + " is " + numberText(other.value));
}

const OptionValue& find(const std::vector<OptionValue>& values, const std::string& name) {
    return *std::find_if(values.begin(), values.end(),
                         [&](const OptionValue& v) { return name == v.row->name; });
}

void requireBeside(const OptionValue& own, const OptionValue& other, bool ownIsUpper,
                   const WasSet& wasSet) {
    const OptionValue &lower = ownIsUpper ? other : own, &upper = ownIsUpper ? own : other;
    if (lower.value <= upper.value) return;
    const bool blameOther = wasSet && wasSet(other.row->name) && !wasSet(own.row->name);
    refusePair(lower, upper, ownIsUpper != blameOther);
}

}  // namespace

void requireInRange(const char* name, double value, double low, double high) {
    const OptionRow row{name, "", low, high, ""};
    requireAlone({&row, value});
}

void requireInRange(const std::vector<OptionValue>& values, const WasSet& wasSet) {
    for (const OptionValue& v : values) requireAlone(v);
    for (const OptionValue& v : values) {
        if (v.row->atLeast) requireBeside(v, find(values, v.row->atLeast), true, wasSet);
        if (v.row->atMost) requireBeside(v, find(values, v.row->atMost), false, wasSet);
    }
}

std::string numberText(double number) {
    char text[64];
    // Numbers of usual size are not written as 1e+05 or 1e-04.
    const double size = std::abs(number);
    const bool isPlain = number == 0.0 || (size >= 1e-5 && size < 1e15);
    const auto end =
        isPlain ? std::to_chars(text, text + sizeof text, number, std::chars_format::fixed)
                : std::to_chars(text, text + sizeof text, number);
    return {text, end.ptr};
}

}  // namespace hgmm
