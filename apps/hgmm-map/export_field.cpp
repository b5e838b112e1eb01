#include "export_field.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "export_slice.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "load.h"

namespace maptool {
namespace {

constexpr int kBrightest = 254, kNotKnown = 255;

/// What a map says at the middles of cells, row by row from the north.
struct Field {
    std::size_t width = 0, height = 0;  ///< [cells]
    std::vector<Eigen::Vector3d> points_map;
    std::vector<hgmm::SurfaceDistance> distances;
    std::vector<hgmm::Occupancy> occupancies;
};

Field fieldOf(const hgmm::Map& map, const ExportOptions& options) {
    const SliceFrame frame = sliceFrameOf(map, options);
    Field field;
    field.width = frame.width;
    field.height = frame.height;
    for (std::size_t row = 0; row < frame.height; ++row)
        for (std::size_t column = 0; column < frame.width; ++column)
            field.points_map.emplace_back(
                frame.lowerLeft_map.x() + (double(column) + 0.5) * frame.resolution_m,
                frame.lowerLeft_map.y() +
                    (double(frame.height - 1 - row) + 0.5) * frame.resolution_m,
                *options.height_m);
    const std::size_t n = field.points_map.size();
    field.distances.resize(n);
    field.occupancies.resize(n);
    hgmm::DistanceParams params;
    params.maxDistance_m = options.maxDistance_m;
    map.distance(field.points_map.data(), n, field.distances.data(), params, options.level);
    map.occupancy(field.points_map.data(), n, field.occupancies.data(), options.level);
    return field;
}

std::string csvOf(const Field& field) {
    std::string text =
        "x,y,z,distance_m,distance_std_m,distance_known,p_occ,p_free,p_unknown\n";
    char line[300];
    for (std::size_t i = 0; i < field.points_map.size(); ++i) {
        const Eigen::Vector3d& p = field.points_map[i];
        const hgmm::SurfaceDistance& d = field.distances[i];
        const hgmm::Occupancy& o = field.occupancies[i];
        std::snprintf(line, sizeof line, "%.10g,%.10g,%.10g,", p.x(), p.y(), p.z());
        text += line;
        if (d.answered()) {
            std::snprintf(line, sizeof line, "%.6g,%.6g,%d", d.distance_m, d.std_m,
                          d.known ? 1 : 0);
            text += line;
        } else {
            text += ",,0";
        }
        std::snprintf(line, sizeof line, ",%.6g,%.6g,%.6g\n", double(o.occupied),
                      double(o.free), double(o.unknown));
        text += line;
    }
    return text;
}

std::string scaleText(const ExportOptions& options) {
    char text[160];
    std::snprintf(
        text, sizeof text, "%s: 0 to %d are 0 to %g m; %d: no surface within %g m",
        options.quantity.c_str(), kBrightest,
        options.quantity == "distance" ? options.maxDistance_m : options.maxDeviation_m,
        kNotKnown, options.maxDistance_m);
    return text;
}

std::string pictureOf(const Field& field, const ExportOptions& options) {
    const bool isDistance = options.quantity == "distance";
    const double most_m = isDistance ? options.maxDistance_m : options.maxDeviation_m;
    std::string text = "P5\n# " + scaleText(options) + "\n" + std::to_string(field.width) +
                       " " + std::to_string(field.height) + "\n255\n";
    for (const hgmm::SurfaceDistance& d : field.distances) {
        const double share = std::min(1.0, (isDistance ? d.distance_m : d.std_m) / most_m);
        text += static_cast<char>(
            d.answered() ? static_cast<int>(std::lround(kBrightest * share)) : kNotKnown);
    }
    return text;
}

}  // namespace

void exportField(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    const Field field = fieldOf(map, options);
    const bool isCsv = options.format == "csv";
    hgmm::mrpt_bridge::writeFile(options.output,
                                 isCsv ? csvOf(field) : pictureOf(field, options),
                                 replaceFor(options.force));
    if (!isCsv) std::cout << scaleText(options) << std::endl;
}

}  // namespace maptool
