#include "studies/figure_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "format.h"

namespace replay {
namespace {

double worstOf(double a, double b, FigureColumn::Worst worst) {
    if (std::isnan(a)) return b;
    if (std::isnan(b)) return a;
    return worst == FigureColumn::Worst::largest ? std::max(a, b) : std::min(a, b);
}

std::string printed(double value, int decimals) {
    if (std::isnan(value)) return "-";
    return std::isinf(value) ? "never" : format("%.*f", decimals, value);
}

/// Rows of cells, each column as wide as its widest cell; the first `left` are words.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t left) {
    std::vector<std::size_t> widths(rows.front().size(), 0);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string gap(widths[i] - row[i].size(), ' ');
            line += "  " + (i < left ? row[i] + gap : gap + row[i]);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

}  // namespace

FigureTable::FigureTable(std::string key, std::string title,
                         std::vector<std::string> labels, std::vector<FigureColumn> columns)
    : key_(std::move(key)),
      title_(std::move(title)),
      labels_(std::move(labels)),
      columns_(std::move(columns)) {}

void FigureTable::add(const std::vector<std::string>& labels,
                      const std::vector<double>& values) {
    if (labels.size() != labels_.size() || values.size() != columns_.size())
        throw std::invalid_argument("table " + key_ + ": a row of another shape");
    for (Row& row : rows_) {
        if (row.labels != labels) continue;
        for (std::size_t i = 0; i < values.size(); ++i)
            row.values[i] = worstOf(row.values[i], values[i], columns_[i].worst);
        return;
    }
    rows_.push_back({labels, values});
}

std::string FigureTable::text() const {
    std::vector<std::vector<std::string>> cells{labels_, {}};
    cells[1].resize(labels_.size());
    cells[1].front() = "goal";
    bool goals = false;
    for (const FigureColumn& column : columns_) {
        cells[0].push_back(column.heading);
        cells[1].push_back(column.goal);
        goals = goals || !column.goal.empty();
    }
    if (!goals) cells.pop_back();
    for (const Row& row : rows_) {
        cells.push_back(row.labels);
        for (std::size_t i = 0; i < row.values.size(); ++i)
            cells.back().push_back(printed(row.values[i], columns_[i].decimals));
    }
    return "\n" + title_ + "\n" + aligned(cells, labels_.size());
}

nlohmann::ordered_json FigureTable::json() const {
    auto all = nlohmann::ordered_json::array();
    for (const Row& row : rows_) {
        nlohmann::ordered_json object;
        for (std::size_t i = 0; i < labels_.size(); ++i) object[labels_[i]] = row.labels[i];
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (std::isnan(row.values[i])) continue;
            if (std::isinf(row.values[i]))
                object[columns_[i].key] = "never";
            else
                object[columns_[i].key] = row.values[i];
        }
        all.push_back(object);
    }
    return all;
}

}  // namespace replay
