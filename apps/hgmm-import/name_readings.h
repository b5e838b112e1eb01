#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace hgmm::importer {

/// One way to read the names of a recording's files as numbers.
struct NameReading {
    std::string what;            ///< for messages: "seconds", "number" ...
    bool isTime = false;         ///< values are times [s], else numbers of scans
    std::vector<double> values;  ///< one for each file
};

/// All ways to read the names, likeliest first: decimal numbers, seconds and nanoseconds,
/// date and time, long whole numbers in one of four units, and the number in the name: the
/// only run of digits that changes, or the last one if the others change along with it.
/// Empty if no reading orders the files without doubt.
std::vector<NameReading> readNames(const std::vector<std::string>& stems);

}  // namespace hgmm::importer
