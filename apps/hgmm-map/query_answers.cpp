#include "query_answers.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace maptool {

namespace {

template <typename... Values>
void appendFormatted(std::string& text, const char* format, Values... values) {
    char buffer[256];
    const int size = std::snprintf(buffer, sizeof buffer, format, values...);
    text.append(buffer, static_cast<std::size_t>(size));
}

/// The shortest text that reads back as the same number.
template <typename Number>
std::string exact(Number number) {
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
    return {buffer, end};
}

struct Column {
    enum class Kind { number, flag };
    std::string name;
    Kind kind = Kind::number;
};

std::vector<Column> columnsOf(const QueryAnswers& answers) {
    using Kind = Column::Kind;
    std::vector<Column> columns = {{"x"},
                                   {"y"},
                                   {"z"},
                                   {"p_occ"},
                                   {"p_free"},
                                   {"p_unknown"},
                                   {"known", Kind::flag},
                                   {"along_ray_m"},
                                   {"along_ray_std_m"}};
    if (answers.hasDistance)
        for (const Column& column :
             std::initializer_list<Column>{{"distance_m"},
                                           {"gradient_x"},
                                           {"gradient_y"},
                                           {"gradient_z"},
                                           {"distance_std_m"},
                                           {"distance_known", Kind::flag}})
            columns.push_back(column);
    for (const std::string& name : answers.modalityNames) {
        columns.push_back({name});
        columns.push_back({name + "_variance"});
    }
    return columns;
}

/// As columnsOf(); empty where nothing is known. Flags are "1" or "0".
std::vector<std::string> rowOf(const QueryAnswers& answers, std::size_t i) {
    std::vector<std::string> row;
    const auto add = [&row](bool known, auto number) {
        row.push_back(known ? exact(number) : std::string());
    };
    for (int d = 0; d < 3; ++d) add(true, answers.points_map[i][d]);
    const hgmm::Occupancy& o = answers.occupancy[i];
    for (const float p : {o.occupied, o.free, o.unknown}) add(true, p);
    add(true, int(o.unknown <= 0.5F));
    add(hasAlongRay(o), o.alongRay_m);
    add(hasAlongRay(o), std::sqrt(o.variance_m2));
    if (answers.hasDistance) {
        const hgmm::SurfaceDistance& s = answers.distance[i];
        add(s.answered(), s.distance_m);
        for (int d = 0; d < 3; ++d) add(s.answered(), s.gradient[d]);
        add(s.answered(), s.std_m);
        add(true, int(s.known));
    }
    for (const auto& ofModality : answers.modalities) {
        add(ofModality[i].known, ofModality[i].mean);
        add(ofModality[i].known, ofModality[i].variance);
    }
    return row;
}

}  // namespace

const char* verdict(const hgmm::Occupancy& answer) {
    if (answer.unknown >= answer.occupied && answer.unknown >= answer.free)
        return "unknown";
    return answer.occupied >= answer.free ? "occupied" : "free";
}

bool hasAlongRay(const hgmm::Occupancy& answer) {
    return answer.unknown < 1.F && answer.variance_m2 > 0.F;
}

std::string listingOf(const QueryAnswers& answers) {
    std::string text =
        "# x y z [m], answer, P(occupied) P(free) P(unknown), distance along the rays and "
        "its standard deviation [m]";
    if (answers.hasDistance)
        text += ", distance [m], gradient x y z, standard deviation [m]";
    for (const std::string& name : answers.modalityNames)
        text += ", " + name + " " + name + "_variance";
    text += "\n";
    for (std::size_t i = 0; i < answers.points_map.size(); ++i) {
        const Eigen::Vector3d& p = answers.points_map[i];
        const hgmm::Occupancy& o = answers.occupancy[i];
        appendFormatted(text, "%.9g %.9g %.9g %s %.4f %.4f %.4f", p.x(), p.y(), p.z(),
                        verdict(o), double(o.occupied), double(o.free), double(o.unknown));
        if (hasAlongRay(o))
            appendFormatted(text, " %.4f %.4f", double(o.alongRay_m),
                            std::sqrt(double(o.variance_m2)));
        else
            text += " - -";
        if (answers.hasDistance) {
            const hgmm::SurfaceDistance& s = answers.distance[i];
            if (s.answered())
                appendFormatted(text, " %.4f %.4f %.4f %.4f %.4f", s.distance_m,
                                s.gradient.x(), s.gradient.y(), s.gradient.z(), s.std_m);
            else
                text += " - - - - -";
        }
        for (const auto& ofModality : answers.modalities)
            if (ofModality[i].known)
                appendFormatted(text, " %.6g %.6g", double(ofModality[i].mean),
                                double(ofModality[i].variance));
            else
                text += " - -";
        text += "\n";
    }
    return text;
}

std::string csvOf(const QueryAnswers& answers) {
    std::string text;
    const auto addLine = [&text](const auto& fields, const auto& textOf) {
        const char* comma = "";
        for (const auto& field : fields) {
            text += comma + textOf(field);
            comma = ",";
        }
        text += "\n";
    };
    addLine(columnsOf(answers), [](const Column& column) { return column.name; });
    for (std::size_t i = 0; i < answers.points_map.size(); ++i)
        addLine(rowOf(answers, i), [](const std::string& field) { return field; });
    return text;
}

std::string jsonLinesOf(const QueryAnswers& answers) {
    const std::vector<Column> columns = columnsOf(answers);
    std::string text;
    for (std::size_t i = 0; i < answers.points_map.size(); ++i) {
        const std::vector<std::string> row = rowOf(answers, i);
        const char* before = "{";
        for (std::size_t c = 0; c < columns.size(); ++c) {
            text += before + nlohmann::json(columns[c].name).dump() + ":";
            if (row[c].empty())
                text += "null";
            else if (columns[c].kind == Column::Kind::flag)
                text += row[c] == "1" ? "true" : "false";
            else
                text += row[c];
            before = ",";
        }
        text += "}\n";
    }
    return text;
}

}  // namespace maptool
