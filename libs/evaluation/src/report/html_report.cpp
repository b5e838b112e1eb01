#include "hgmm/evaluation/html_report.h"

#include <algorithm>

#include "hgmm/evaluation/cost_plots.h"
#include "hgmm/evaluation/occupancy_plots.h"
#include "report/markup.h"
#include "report/report_style.h"
#include "report/report_tables.h"

namespace hgmm::evaluation {
namespace {

std::string fact(const std::string& name, const std::string& value) {
    return "<div><dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd></div>\n";
}

std::string percent(double share) {
    return formatted("%g %%", 100.0 * share);
}

/// What the test points are.
std::string splitText(const SplitParams& split) {
    std::string text;
    if (split.every > 0)
        text = "one scan of " + std::to_string(split.every) + " tests the maps";
    if (split.holdoutPoints > 0.0)
        text += (text.empty() ? "" : "; ") + percent(split.holdoutPoints) +
                " of the points of mapping scans are held out";
    return text.empty() ? "all scans build the maps, none tests them" : text;
}

std::string facts(const Run& run) {
    std::string html = "<dl class=\"facts\">\n" + fact("Sensor", run.sensor);
    html += fact("Scans", std::to_string(run.scansMapped) + " mapped, " +
                              std::to_string(run.scansTested) + " tested, " +
                              formatted("%.0f points each", run.pointsPerScan));
    html += fact("Split", splitText(run.split));
    if (run.split.subsample < 1.0)
        html += fact("Points used", percent(run.split.subsample) + " of each mapping scan");
    if (run.rangeNoise_m > 0.0)
        html +=
            fact("Noise added to ranges", formatted("%g m, one sigma", run.rangeNoise_m));
    html += fact("Hits asked for", "up to " + std::to_string(run.queriesPerScan) +
                                       " of each scan with test points");
    html += fact("Near free points",
                 formatted("%g", run.nearBand.min_m) +
                     formatted(" to %g m before the hit", run.nearBand.max_m));
    html += fact("Uniform free points",
                 formatted("%g m after the sensor", run.freeBand.fromSensor_m) +
                     formatted(" to %g m before the hit", run.freeBand.beforeHit_m));
    html += fact("Seed", std::to_string(run.split.seed));
    html +=
        fact("Threads", std::to_string(run.threads) + " for the first map, 1 for others");
    return html + "</dl>\n";
}

std::string heading(const Run& run) {
    std::string html = "<header>\n<h1>" + escaped(run.dataset) +
                       "</h1>\n<p class=\"note\">Occupancy maps built from the same scans "
                       "and asked about the same points, by hgmm-replay.</p>\n";
    if (run.interrupted)
        html +=
            "<p class=\"warning\">The run was interrupted: everything here is of the scans "
            "until then.</p>\n";
    return html + facts(run) + "</header>\n";
}

std::string tables(const std::vector<MapFigures>& maps) {
    const bool tested = std::any_of(maps.begin(), maps.end(),
                                    [](const MapFigures& m) { return m.occupancy; });
    std::string html = "<section>\n<h2>Maps</h2>\n";
    if (tested)
        html += accuracyTable(maps) +
                "<p class=\"note\">\u2191 higher is better, \u2193 lower is better, best "
                "in bold. AUC: chance that a hit scores higher than a free point. TPR: "
                "share of hits found while 5 % of near free points are mistaken for "
                "occupied. Brier score and expected calibration error (ECE) judge the "
                "probabilities themselves.</p>\n";
    else
        html += "<p>There were no test points, so accuracy was not measured.</p>\n";
    return html + costTable(maps) +
           "<p class=\"note\">Saved: before compression. Live: heap held, by the "
           "map\u2019s "
           "own account. First and last tenth: medians, whose difference is the "
           "trend.</p>\n</section>\n";
}

/// Nothing for a plot without any map in it.
std::string plotFigure(const Plot& plot, const std::string& caption) {
    const bool showsMaps =
        std::any_of(plot.curves.begin(), plot.curves.end(),
                    [](const Curve& c) { return !c.label.empty() && !c.points.empty(); });
    if (!showsMaps) return "";
    return "<figure>\n" + toInlineSvg(plot) + "<figcaption>" + escaped(caption) +
           "</figcaption>\n</figure>\n";
}

std::string plots(const std::vector<MapFigures>& maps) {
    return "<section>\n<h2>Plots</h2>\n<div class=\"grid\">\n" +
           plotFigure(rocNearPlot(maps),
                      "Receiver operating characteristic against free points close before "
                      "the hit, the hard ones. Grey: guessing.") +
           plotFigure(rocUniformPlot(maps),
                      "The same against free points anywhere along the ray; as maps "
                      "mistake few of them, the false positive rate is logarithmic.") +
           plotFigure(
               reliabilityPlot(maps),
               "On the grey diagonal, probabilities are what they claim to be; above "
               "it, maps are too cautious about what is occupied.") +
           plotFigure(levelsPlot(maps),
                      "Further left is smaller, higher is better. Levels of one hierarchy "
                      "are joined, from the base on the right; they count what they take "
                      "when saved, as do other maps that can be; the rest count by their "
                      "own account.") +
           plotFigure(insertionPlot(maps),
                      "Below is faster; a rise is the price of a map "
                      "that grows.") +
           plotFigure(memoryPlot(maps),
                      "By each map\u2019s own account, while it was built.") +
           "</div>\n</section>\n";
}

std::string pictureFigures(const std::vector<ReportPicture>& pictures) {
    if (pictures.empty()) return "";
    std::string html = "<section>\n<h2>Pictures</h2>\n<div class=\"grid\">\n";
    for (const ReportPicture& p : pictures)
        html += "<figure>\n<h3>" + escaped(p.title) + "</h3>\n<img alt=\"" +
                escaped(p.title) + "\" width=\"" + std::to_string(p.picture.width_px) +
                "\" height=\"" + std::to_string(p.picture.height_px) +
                "\" src=\"data:image/png;base64," + base64(pngOf(p.picture)) +
                "\">\n<figcaption>" + escaped(p.caption) + "</figcaption>\n</figure>\n";
    return html + "</div>\n</section>\n";
}

/// What only some maps can be asked for.
std::string moreFigures(const MapFigures& map) {
    std::string text;
    if (!map.levels.empty())
        text += std::to_string(map.levels.front().components) +
                " components of surfaces, " +
                std::to_string(map.levels.front().componentsFree) + " of free space. ";
    if (map.logLikelihoodOfHits)
        text += "Held-out log-likelihood " +
                formatted("%.3f nat/point. ", *map.logLikelihoodOfHits);
    if (map.reconstruction)
        text += "Reconstruction: F1 at 5 cm " +
                formatted("%.4f, ", map.reconstruction->f1) +
                formatted("Chamfer distance %.2f cm.", 100 * map.reconstruction->chamfer_m);
    return text.empty() ? "" : "<p>" + escaped(text) + "</p>\n";
}

std::string origins(const std::vector<MapFigures>& maps) {
    std::string html = "<section>\n<h2>Where the maps come from</h2>\n";
    for (const MapFigures& map : maps) {
        html += "<div class=\"map\">\n<h3>" + escaped(map.name) + "</h3>\n<p><code>" +
                escaped(map.className) + "</code></p>\n<p>" + escaped(map.source) +
                "</p>\n" + moreFigures(map);
        if (!map.options.empty()) html += "<p class=\"options\">";
        for (const auto& [name, value] : map.options)
            html +=
                "<span>" + escaped(name) + " = " + formatted("%.6g", value) + "</span> ";
        html += map.options.empty() ? "</div>\n" : "</p>\n</div>\n";
    }
    return html + "</section>\n";
}

}  // namespace

std::string htmlReport(const Run& run, const std::vector<MapFigures>& maps,
                       const std::vector<ReportPicture>& pictures) {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<title>" +
           escaped(run.dataset) +
           ": occupancy maps compared</title>\n<link rel=\"icon\" href=\"data:,\">\n"
           "<style>" +
           std::string(kReportStyle) + "</style>\n</head>\n<body>\n" + heading(run) +
           tables(maps) + pictureFigures(pictures) + plots(maps) + origins(maps) +
           "</body>\n</html>\n";
}

}  // namespace hgmm::evaluation
