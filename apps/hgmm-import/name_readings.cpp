#include "name_readings.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <numeric>
#include <optional>

namespace hgmm::importer {
namespace {

constexpr std::size_t kMostDigits = 19;  // what an unsigned long long surely holds
constexpr std::size_t kStampDigits = 9;  // seconds of our epoch have ten
constexpr double kMostScans = 1e8;       // larger numbers are stamps
constexpr std::size_t kNanoDigits = 9;

bool isDigitOfName(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// A run of digits of a name, and what stands between it and the run before.
struct Run {
    std::string before, digits;
};
using Runs = std::vector<Run>;

Runs runsOf(const std::string& stem) {
    Runs runs;
    std::string before;
    for (std::size_t i = 0; i < stem.size();) {
        if (!isDigitOfName(stem[i])) {
            before += stem[i++];
            continue;
        }
        std::string digits;
        while (i < stem.size() && isDigitOfName(stem[i])) digits += stem[i++];
        runs.push_back({before, digits});
        before.clear();
    }
    return runs;
}

double toNumber(const std::string& digits) {
    return static_cast<double>(std::stoull(digits));
}

/// Runs of all names, the last ones below each other.
class RunTable {
 public:
    explicit RunTable(const std::vector<std::string>& stems) {
        for (const auto& stem : stems) rows_.push_back(runsOf(stem));
        for (const auto& row : rows_)
            columns_ = columns_ ? std::min(*columns_, row.size()) : row.size();
        for (auto& row : rows_)
            row.erase(row.begin(), row.end() - static_cast<long>(columns()));
    }
    std::size_t columns() const { return columns_.value_or(0); }
    const std::vector<Runs>& rows() const { return rows_; }
    bool varies(std::size_t column) const {
        return !all(column, [&](const Run& run) {
            return run.digits == rows_.front()[column].digits;
        });
    }
    template <typename Condition>
    bool all(std::size_t column, Condition condition) const {
        return std::all_of(rows_.begin(), rows_.end(),
                           [&](const Runs& row) { return condition(row[column]); });
    }
    bool haveWidth(std::size_t column, std::size_t width) const {
        return all(column, [&](const Run& run) { return run.digits.size() == width; });
    }
    bool areJoined(std::size_t column, const std::string& separators) const {
        return all(column, [&](const Run& run) {
            return run.before.size() == 1 &&
                   separators.find(run.before[0]) != std::string::npos;
        });
    }
    template <typename Value>
    NameReading read(const std::string& what, bool isTime, Value value) const {
        NameReading reading{what, isTime, {}};
        for (const auto& row : rows_) reading.values.push_back(value(row));
        return reading;
    }

 private:
    std::vector<Runs> rows_;
    std::optional<std::size_t> columns_;
};

/// Whether files in the order of these values are in the order of all runs, too, and no two
/// have the same.
bool ordersAsTheNames(const NameReading& reading, const RunTable& table) {
    std::vector<std::size_t> order(reading.values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return reading.values[a] < reading.values[b];
    });
    const auto numbers = [&](std::size_t file) {
        std::vector<double> result;
        for (const auto& run : table.rows()[file]) result.push_back(toNumber(run.digits));
        return result;
    };
    for (std::size_t i = 1; i < order.size(); ++i)
        if (!(reading.values[order[i - 1]] < reading.values[order[i]]) ||
            !(numbers(order[i - 1]) < numbers(order[i])))
            return false;
    return true;
}

/// Year, month, day, hour, minute, second that end at a column, in two runs or in six.
std::optional<double> dateAt(const Runs& row, std::size_t column) {
    std::string digits = row[column].digits;
    if (digits.size() == 6 && column >= 1) {
        digits.insert(0, row[column - 1].digits);
    } else if (digits.size() == 2 && column >= 5) {
        for (std::size_t k = 1; k <= 5; ++k) digits.insert(0, row[column - k].digits);
    }
    if (digits.size() != 14) return std::nullopt;
    const auto part = [&](std::size_t at, std::size_t n) {
        return std::stoi(digits.substr(at, n));
    };
    std::tm time{};
    time.tm_year = part(0, 4) - 1900;
    time.tm_mon = part(4, 2) - 1;
    time.tm_mday = part(6, 2);
    time.tm_hour = part(8, 2);
    time.tm_min = part(10, 2);
    time.tm_sec = part(12, 2);
    const bool plausible = time.tm_year >= 70 && time.tm_year < 300 && time.tm_mon < 12 &&
                           time.tm_mon >= 0 && time.tm_mday >= 1 && time.tm_mday <= 31 &&
                           time.tm_hour < 24 && time.tm_min < 60 && time.tm_sec <= 60;
    if (!plausible) return std::nullopt;
    return static_cast<double>(timegm(&time));
}

double fraction(const std::string& digits) {
    return toNumber(digits) * std::pow(10.0, -static_cast<double>(digits.size()));
}

using Readings = std::vector<NameReading>;

/// Whole and part of a second in neighbouring runs.
void addPairs(const RunTable& table, std::size_t whole, Readings& readings) {
    const std::size_t part = whole + 1;
    const bool decimal = table.areJoined(part, ".");
    const bool nanoseconds = table.haveWidth(part, kNanoDigits);
    const bool stamp = nanoseconds || table.all(whole, [](const Run& run) {
        return run.digits.size() >= kStampDigits;
    });
    if (!decimal && !(table.areJoined(part, "_-") && stamp)) return;
    std::size_t width = table.rows().front()[part].digits.size();
    const bool sameWidth = table.haveWidth(part, width);
    for (const auto& row : table.rows()) width = std::max(width, row[part].digits.size());
    const auto asDecimal = table.read("decimal seconds", true, [&](const Runs& row) {
        return toNumber(row[whole].digits) + fraction(row[part].digits);
    });
    const auto asUnits = [&](const std::string& what, double unit) {
        return table.read(what, true, [&, unit](const Runs& row) {
            return toNumber(row[whole].digits) + unit * toNumber(row[part].digits);
        });
    };
    if (decimal || sameWidth) readings.push_back(asDecimal);
    if (width <= kNanoDigits && !nanoseconds)
        readings.push_back(asUnits("seconds and nanoseconds", 1e-9));
    if (width < 6 || (width == 6 && !sameWidth))
        readings.push_back(asUnits("seconds and microseconds", 1e-6));
    if (!decimal && !sameWidth) readings.push_back(asDecimal);
}

void addDates(const RunTable& table, std::size_t seconds, Readings& readings) {
    const bool dates =
        std::all_of(table.rows().begin(), table.rows().end(),
                    [&](const Runs& row) { return dateAt(row, seconds).has_value(); });
    if (!dates) return;
    const bool fractions =
        seconds + 1 < table.columns() && table.areJoined(seconds + 1, ".-_");
    readings.push_back(table.read("date and time, UTC", true, [&](const Runs& row) {
        return *dateAt(row, seconds) +
               (fractions ? fraction(row[seconds + 1].digits) : 0.0);
    }));
}

/// A whole number as a time in each unit.
void addUnits(const NameReading& number, Readings& readings) {
    const std::pair<const char*, double> units[] = {
        {"seconds", 1}, {"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}};
    for (const auto& [what, perSecond] : units) {
        NameReading reading{what, true, number.values};
        for (double& value : reading.values) value /= perSecond;
        readings.push_back(reading);
    }
}

/// Columns that may hold the scan's number, likeliest first: those before the runs that are
/// read as times, then, unless these are stamps for certain, the others.
std::vector<std::size_t> numberColumns(std::size_t last, const Readings& times) {
    std::vector<std::size_t> columns;
    const std::size_t firstOfTime = times.empty() || last == 0 ? 0 : last - 1;
    for (std::size_t c = firstOfTime; c-- > 0;) columns.push_back(c);
    const bool stamps = std::any_of(times.begin(), times.end(), [](const auto& reading) {
        return reading.values.front() >= kMostScans;
    });
    if (stamps) return columns;
    for (std::size_t c = last + 1; c-- > firstOfTime;) columns.push_back(c);
    return columns;
}

/// The number of the scan in the last column that orders the files as all of them do.
std::optional<NameReading> numberIn(const RunTable& table, std::size_t last,
                                    const Readings& times) {
    for (const std::size_t column : numberColumns(last, times)) {
        auto number = table.read(
            "number", false, [&](const Runs& row) { return toNumber(row[column].digits); });
        const bool tells = column == last || table.varies(column);
        if (tells && ordersAsTheNames(number, table)) return number;
    }
    return std::nullopt;
}

}  // namespace

std::vector<NameReading> readNames(const std::vector<std::string>& stems) {
    const RunTable table(stems);
    Readings readings;
    if (table.columns() == 0) return readings;
    for (const auto& row : table.rows())
        for (const auto& run : row)
            if (run.digits.size() > kMostDigits) return readings;
    std::size_t column = table.columns() - 1;
    while (column > 0 && !table.varies(column)) --column;
    if (!table.varies(column)) column = table.columns() - 1;

    for (const std::size_t seconds : {column, column - 1})
        if (seconds < table.columns()) addDates(table, seconds, readings);
    if (readings.empty() && column + 1 < table.columns()) addPairs(table, column, readings);
    if (readings.empty() && column > 0) addPairs(table, column - 1, readings);
    const auto number = numberIn(table, column, readings);
    if (!number) return readings;
    const bool isLong =
        *std::max_element(number->values.begin(), number->values.end()) >= kMostScans;
    if (isLong) addUnits(*number, readings);
    readings.push_back(*number);
    if (!isLong) addUnits(*number, readings);
    return readings;
}

}  // namespace hgmm::importer
