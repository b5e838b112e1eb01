#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace replay {

/// One figure of a table.
struct FigureColumn {
    /// Which of the values over the seeds is reported.
    enum class Worst { largest, smallest };

    std::string heading;
    std::string key;  ///< in metrics.json
    int decimals;     ///< printed
    Worst worst;
    std::string goal = {};  ///< printed below the heading
};

/// A table of figures, a row for each setting, worst over seeds. A figure that was not
/// taken is NaN; what never came about is infinity.
class FigureTable {
 public:
    FigureTable(std::string key, std::string title, std::vector<std::string> labels,
                std::vector<FigureColumn> columns);

    /// Adds the figures of one seed: rows of the same labels become one. Throws
    /// std::invalid_argument if a label or value is missing or too many.
    void add(const std::vector<std::string>& labels, const std::vector<double>& values);

    bool empty() const { return rows_.empty(); }
    const std::string& key() const { return key_; }
    std::string text() const;
    /// An array with an object for each row; what was not taken is left out, what never
    /// came about is the text "never".
    nlohmann::ordered_json json() const;

 private:
    struct Row {
        std::vector<std::string> labels;
        std::vector<double> values;
    };

    std::string key_, title_;
    std::vector<std::string> labels_;
    std::vector<FigureColumn> columns_;
    std::vector<Row> rows_;
};

}  // namespace replay
