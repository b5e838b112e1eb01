#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/ply.h"
#include "hgmm/evaluation/sensor_kind.h"
#include "options.h"

namespace replay {

/// How a picture looks at points: an orthographic view from outside.
struct View {
    double yaw_deg = 35.0;    ///< of the viewing direction about z [deg]
    double pitch_deg = 40.0;  ///< of the viewing direction below the horizon [deg]
    double cut = 0.0;  ///< share of the depth, from the viewer on, left out, in [0, 1)
};

/// How pictures of reports look at maps: into rooms, at what is outdoors.
View reportView(hgmm::evaluation::SensorKind sensor);

/// A picture of a report: points, by their colours, their values or their height.
struct PointPicture {
    std::string title, caption;
    std::string file;  ///< its name in the folder, .ply
    hgmm::evaluation::Ply points;
    View view;
    std::optional<double> edge_m;  ///< of the voxels that points stand for
    std::optional<std::pair<double, double>>
        scale;  ///< values of the first and last colour
};

/// Writes metrics.json, the points of the pictures beside it, and report.html by the Python
/// package: where that cannot be had, says so in one sentence. Throws std::runtime_error
/// naming the file that cannot be written.
void writeReportFiles(nlohmann::ordered_json metrics, const Options& options,
                      const std::vector<PointPicture>& pictures = {});

}  // namespace replay
