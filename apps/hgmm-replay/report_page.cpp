#include "report_page.h"

#include <cstdio>
#include <filesystem>

#include "hgmm/evaluation/python_module.h"
#include "hgmm/mrpt_bridge/output_file.h"

namespace replay {
namespace {

using Json = nlohmann::ordered_json;
using namespace hgmm::evaluation;

Json pictureJson(const PointPicture& picture) {
    Json json{{"title", picture.title},
              {"caption", picture.caption},
              {"file", picture.file},
              {"yaw_deg", picture.view.yaw_deg},
              {"pitch_deg", picture.view.pitch_deg},
              {"cut", picture.view.cut}};
    if (picture.edge_m) json["edge_m"] = *picture.edge_m;
    if (picture.scale) json["scale"] = {picture.scale->first, picture.scale->second};
    return json;
}

void makePage(const Options& options) {
    const std::string& folder = *options.reportFolder;
    std::vector<std::string> arguments{"-o", "-"};
    if (options.poses) arguments.push_back("--poses=" + *options.poses);
    arguments.insert(arguments.end(), {"--", folder});
    const PythonRun made = runPython("hgmm.report", arguments);
    if (made.done) {
        hgmm::mrpt_bridge::writeFile(folder + "/report.html", made.output);
        std::fputs(made.message.c_str(), stderr);
    } else {
        // A page of an earlier run would show other figures than those beside it.
        std::filesystem::remove(folder + "/report.html");
        std::fprintf(
            stderr,
            "report.html was not made (%s); %s/metrics.json is complete, and 'python3 -m "
            "hgmm.report %s' makes the page of it\n",
            made.message.c_str(), folder.c_str(), folder.c_str());
    }
}

}  // namespace

View reportView(SensorKind sensor) {
    View view;
    // Depth cameras see rooms from within, whose near walls would hide the rest.
    view.cut = sensor == SensorKind::depthCamera ? 0.3 : 0.0;
    return view;
}

void writeReportFiles(Json metrics, const Options& options,
                      const std::vector<PointPicture>& pictures) {
    const std::string& folder = *options.reportFolder;
    for (const PointPicture& picture : pictures) {
        writePly(folder + "/" + picture.file, picture.points);
        metrics["pictures"].push_back(pictureJson(picture));
    }
    hgmm::mrpt_bridge::writeFile(folder + "/metrics.json", metrics.dump(2) + "\n");
    makePage(options);
}

}  // namespace replay
