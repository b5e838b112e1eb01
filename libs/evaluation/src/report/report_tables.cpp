#include "report/report_tables.h"

#include <cmath>
#include <functional>
#include <optional>

#include "report/markup.h"

namespace hgmm::evaluation {
namespace {

enum class Best { highest, lowest, none };

struct Column {
    const char* heading;
    const char* unit;  ///< below the heading
    Best best;
    const char* pattern;  ///< of printf
    std::function<std::optional<double>(const MapFigures&)> value;
};

constexpr const char* kDash = "\u2013";
constexpr const char* kNearFree = "near free points";

std::string textOf(const Column& column, const MapFigures& map) {
    const std::optional<double> value = column.value(map);
    return value && std::isfinite(*value) ? formatted(column.pattern, *value) : kDash;
}

/// What the best of a column reads; nothing if there is none to compare.
std::optional<std::string> bestText(const Column& column,
                                    const std::vector<MapFigures>& maps) {
    const double sign = column.best == Best::lowest ? -1.0 : 1.0;
    std::optional<std::string> best;
    double bestValue = -INFINITY;
    int compared = 0;
    for (const MapFigures& map : maps) {
        const std::optional<double> value = column.value(map);
        if (!map.ranked || !value || !std::isfinite(*value)) continue;
        ++compared;
        if (sign * *value <= bestValue) continue;
        bestValue = sign * *value;
        best = textOf(column, map);
    }
    return column.best == Best::none || compared < 2 ? std::nullopt : best;
}

std::string whyNotRanked(const MapFigures& map) {
    switch (map.meaning) {
        case Meaning::surfaceLikelihood:
            return "its answer is a likelihood of surfaces, not a probability of occupancy";
        case Meaning::nearness:
            return "its answer tells how near a measured point is, not a probability of "
                   "occupancy";
        default:
            return "shown for comparison";
    }
}

std::string row(const MapFigures& map, const std::vector<Column>& columns,
                const std::vector<std::optional<std::string>>& best) {
    std::string html = "<tr><th scope=\"row\">" + escaped(map.name);
    if (!map.ranked) html += "<small>" + whyNotRanked(map) + "</small>";
    html += "</th>";
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::string text = textOf(columns[i], map);
        const bool bold = map.ranked && best[i] == text;
        html += bold ? "<td><b>" + text + "</b></td>" : "<td>" + text + "</td>";
    }
    return html + "</tr>\n";
}

std::string table(const std::string& caption, const std::vector<MapFigures>& maps,
                  const std::vector<Column>& columns) {
    const std::string title = escaped(caption);
    std::string html =
        "<h3>" + title +
        "</h3>\n<div class=\"scroll\" tabindex=\"0\">\n<table aria-label=\"" + title +
        "\">\n<thead><tr><th scope=\"col\">Map</th>";
    std::vector<std::optional<std::string>> best;
    for (const Column& column : columns) {
        static const char* const arrows[] = {"\u00a0\u2191", "\u00a0\u2193", ""};
        html += std::string("<th scope=\"col\">") + escaped(column.heading) +
                arrows[static_cast<int>(column.best)] + "<small>" + escaped(column.unit) +
                "</small></th>";
        best.push_back(bestText(column, maps));
    }
    html += "</tr></thead>\n<tbody>\n";
    std::string others;
    for (const MapFigures& map : maps)
        (map.ranked ? html : others) += row(map, columns, best);
    html += "</tbody>\n";
    if (!others.empty()) html += "<tbody class=\"unranked\">\n" + others + "</tbody>\n";
    return html + "</table>\n</div>\n";
}

/// A figure of occupancy, where there is one.
auto figure(double OccupancyFigures::*member) {
    return [member](const MapFigures& map) -> std::optional<double> {
        if (!map.occupancy) return std::nullopt;
        return (*map.occupancy).*member;
    };
}

/// The same, but only of answers that are probabilities.
auto probabilityFigure(double OccupancyFigures::*member) {
    return [member](const MapFigures& map) -> std::optional<double> {
        if (!map.occupancy || map.meaning != Meaning::occupancy) return std::nullopt;
        return (*map.occupancy).*member;
    };
}

std::optional<double> tprNear(const MapFigures& map) {
    constexpr double fpr = 0.05;
    if (!map.occupancy || map.occupancy->rocNear.empty()) return std::nullopt;
    return tprAt(map.occupancy->rocNear, fpr);
}

constexpr double kKilobyte = 1000.0;

std::optional<double> serialisedKilobytes(const MapFigures& map) {
    if (!map.memory.serialized_bytes) return std::nullopt;
    return static_cast<double>(*map.memory.serialized_bytes) / kKilobyte;
}

std::optional<double> liveKilobytes(const MapFigures& map) {
    if (map.memory.live_bytes == 0) return std::nullopt;
    return static_cast<double>(map.memory.live_bytes) / kKilobyte;
}

auto time(double Timing::*member) {
    return [member](const MapFigures& map) -> std::optional<double> {
        if (map.insert_ms.empty()) return std::nullopt;
        return map.scanTime_ms.*member;
    };
}

std::optional<double> thousandQueries(const MapFigures& map) {
    if (!map.occupancy) return std::nullopt;
    return map.occupancy->queriesPerSecond / 1000.0;
}

}  // namespace

std::string accuracyTable(const std::vector<MapFigures>& maps) {
    using F = OccupancyFigures;
    return table(
        "Accuracy of occupancy at points that no map saw", maps,
        {{"AUC", "uniform free points", Best::highest, "%.4f", figure(&F::aucUniform)},
         {"AUC", kNearFree, Best::highest, "%.4f", figure(&F::aucNear)},
         {"TPR at 5 % FPR", kNearFree, Best::highest, "%.4f", tprNear},
         {"Balanced accuracy", kNearFree, Best::highest, "%.4f",
          probabilityFigure(&F::balancedAccuracyNear)},
         {"Brier score", kNearFree, Best::lowest, "%.4f", probabilityFigure(&F::brier)},
         {"ECE", kNearFree, Best::lowest, "%.4f", probabilityFigure(&F::ece)},
         {"Unknown", "share of hits", Best::none, "%.3f", figure(&F::unknownShareHit)},
         {"Unknown", "of uniform free", Best::none, "%.3f", figure(&F::unknownShareFree)},
         {"Unknown", "of near free", Best::none, "%.3f", figure(&F::unknownShareNear)}});
}

std::string costTable(const std::vector<MapFigures>& maps) {
    return table(
        "Cost", maps,
        {{"Saved", "KB", Best::lowest, "%.1f", serialisedKilobytes},
         {"Live", "KB", Best::lowest, "%.1f", liveKilobytes},
         {"Insertion, median", "ms/scan", Best::lowest, "%.2f", time(&Timing::median)},
         {"99th percentile", "ms/scan", Best::lowest, "%.2f", time(&Timing::p99)},
         {"Worst", "ms/scan", Best::lowest, "%.2f", time(&Timing::worst)},
         {"First tenth", "ms/scan", Best::none, "%.2f", time(&Timing::firstTenth)},
         {"Last tenth", "ms/scan", Best::none, "%.2f", time(&Timing::lastTenth)},
         {"Queries", "thousands/s", Best::highest, "%.0f", thousandQueries}});
}

}  // namespace hgmm::evaluation
