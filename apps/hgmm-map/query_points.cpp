#include "query_points.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <utility>

#include "parse_point.h"

namespace maptool {

namespace {

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The fields of a line of a CSV, without quotes around them. Throws std::runtime_error
/// starting with `where` for a quote that is not closed.
std::vector<std::string> fieldsOf(const std::string& line, const std::string& where) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool isDouble = quoted && line.compare(i, 2, "\"\"") == 0;
        if (line[i] == '"' && !isDouble) {
            quoted = !quoted;
        } else if (line[i] == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += line[i];
            if (isDouble) ++i;
        }
    }
    if (quoted) throw std::runtime_error(where + ": a quote is not closed");
    std::transform(fields.begin(), fields.end(), fields.begin(), trimmed);
    return fields;
}

bool beginsWithNumber(const std::string& line) {
    char* end = nullptr;
    std::strtod(line.c_str(), &end);
    return end != line.c_str();
}

/// Where a CSV has its points.
class Columns {
 public:
    Columns(const std::string& header, const std::string& where)
        : fields_(fieldsOf(header, where)) {
        for (int d = 0; d < 3; ++d) {
            const std::string name(1, "xyz"[d]);
            if (std::count(fields_.begin(), fields_.end(), name) != 1)
                throw std::runtime_error(where + ": needs one column " + name +
                                         ", or three numbers x y z in every line");
            place_[d] = static_cast<std::size_t>(
                std::find(fields_.begin(), fields_.end(), name) - fields_.begin());
        }
    }

    Eigen::Vector3d pointOf(const std::string& line, const std::string& where) const {
        const std::vector<std::string> fields = fieldsOf(line, where);
        if (fields.size() != fields_.size())
            throw std::runtime_error(where + ": has " + std::to_string(fields.size()) +
                                     " fields, the header " +
                                     std::to_string(fields_.size()));
        return parsePoint(
            fields[place_[0]] + "," + fields[place_[1]] + "," + fields[place_[2]], where);
    }

 private:
    std::vector<std::string> fields_;
    std::array<std::size_t, 3> place_{};
};

}  // namespace

std::vector<Eigen::Vector3d> readPoints(const std::string& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error(file + ": cannot be opened");
    std::vector<Eigen::Vector3d> points;
    std::optional<Columns> columns;
    std::size_t number = 0;
    bool first = true;
    for (std::string line; std::getline(in, line);) {
        // Spreadsheets begin files with a byte order mark.
        if (++number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0) line.erase(0, 3);
        line = trimmed(line);
        if (line.empty() || line[0] == '#') continue;
        const std::string where = file + ":" + std::to_string(number);
        if (std::exchange(first, false) && !beginsWithNumber(line))
            columns.emplace(line, where);
        else
            points.push_back(columns ? columns->pointOf(line, where)
                                     : parsePoint(line, where));
    }
    if (in.bad()) throw std::runtime_error(file + ": cannot be read");
    return points;
}

}  // namespace maptool
