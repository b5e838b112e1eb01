#include "studies/modality_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "format.h"
#include "hgmm/evaluation/metrics_json.h"
#include "hgmm/evaluation/timing.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using Json = nlohmann::ordered_json;

double inKilobytes(std::size_t bytes) {
    return static_cast<double>(bytes) / 1000.0;
}

double sumOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

double insertionRatio(const ModalityFindings& findings) {
    return sumOf(findings.insertWith_ms) / sumOf(findings.insertWithout_ms);
}

double varianceRatio(const ModalityScore& score) {
    return score.mseOfLeastSure / std::max(score.mseOfSurest, 1e-12);
}

/// Mean and least of a figure over the maps of one scan.
struct Spread {
    double mean = 0.0, least = std::numeric_limits<double>::infinity();
};
template <typename Figure>
Spread spreadOf(const ModalityFindings& findings, Figure&& figure) {
    Spread spread;
    for (const ModalityMapResult& scan : findings.scans) {
        const double value = figure(scan);
        spread.mean += value / static_cast<double>(findings.scans.size());
        spread.least = std::min(spread.least, value);
    }
    return spread;
}

std::string sequenceLine(const ModalityResult& m) {
    return format("  %-12s  %6.3f  %19.1f  %11zu  %8.1f\n", m.name.c_str(), m.score.r2,
                  varianceRatio(m.score), m.components, inKilobytes(m.bytes));
}

std::string scansTable(const ModalityFindings& findings) {
    std::string text = format(
        "maps of one scan each, %zu scans: R^2 at held-out points, mean (least)\n"
        "  modality      reconstruction   error worst/best*",
        findings.scans.size());
    const bool crossModal = findings.names.size() > 1;
    text += crossModal ? "   inferred, 10 % poor   regressed, 10 % poor\n" : "\n";
    for (std::size_t i = 0; i < findings.names.size(); ++i) {
        const auto of = [&](auto figure) {
            return spreadOf(findings,
                            [&](const ModalityMapResult& r) { return figure(r); });
        };
        const Spread r2 =
            of([&](const ModalityMapResult& r) { return r.modalities[i].score.r2; });
        const Spread ratio = of([&](const ModalityMapResult& r) {
            return varianceRatio(r.modalities[i].score);
        });
        text += format("  %-12s  %6.3f (%5.3f)   %8.1f (%.1f)", findings.names[i].c_str(),
                       r2.mean, r2.least, ratio.mean, ratio.least);
        if (crossModal) {
            const Spread inferred =
                of([&](const ModalityMapResult& r) { return r.crossModal[i].r2Inferred; });
            const Spread regressed =
                of([&](const ModalityMapResult& r) { return r.crossModal[i].r2Regressed; });
            text += format("       %6.3f (%5.3f)         %6.3f (%5.3f)", inferred.mean,
                           inferred.least, regressed.mean, regressed.least);
        }
        text += "\n";
    }
    const Spread bytes = spreadOf(
        findings, [](const ModalityMapResult& r) { return -inKilobytes(r.modalityBytes); });
    return text + format("  all modalities of a scan: %.1f KB on average, %.1f at most\n",
                         -bytes.mean, -bytes.least);
}

std::string sequenceTable(const ModalityFindings& findings) {
    std::string text = format(
        "map of all scans: R^2 at %zu held-out points\n"
        "  modality      R^2     error worst/best*   components        KB\n",
        findings.sequence.modalities.front().score.points);
    for (const ModalityResult& m : findings.sequence.modalities) text += sequenceLine(m);
    text += format("  %.1f KB for the modalities together, %.1f KB for the whole map\n",
                   inKilobytes(findings.sequence.modalityBytes),
                   inKilobytes(findings.sequence.mapBytes));
    text +=
        format("  insertion %.2f ms a scan with modalities, %.2f without: ratio %.2f\n",
               sumOf(findings.insertWith_ms) / double(findings.insertWith_ms.size()),
               sumOf(findings.insertWithout_ms) / double(findings.insertWithout_ms.size()),
               insertionRatio(findings));
    if (findings.query_us)
        text += format("  cross-modal query %.1f us, one thread\n", *findings.query_us);
    return text;
}

Json resultJson(const ModalityMapResult& result) {
    Json json{{"bytes_modalities", result.modalityBytes},
              {"bytes_serialized", result.mapBytes}};
    for (const ModalityResult& m : result.modalities)
        json["modalities"].push_back({{"name", m.name},
                                      {"points", m.score.points},
                                      {"known_share", m.score.knownShare},
                                      {"r2", m.score.r2},
                                      {"mse", m.score.mse},
                                      {"mse_surest_tenth", m.score.mseOfSurest},
                                      {"mse_least_sure_tenth", m.score.mseOfLeastSure},
                                      {"components", m.components},
                                      {"bytes", m.bytes}});
    for (const CrossModalResult& c : result.crossModal)
        json["cross_modal"].push_back({{"target", c.target},
                                       {"r2_inferred", c.r2Inferred},
                                       {"r2_regressed", c.r2Regressed},
                                       {"query_us", c.query_us}});
    return json;
}

/// What all but a few values do not exceed; more than 0.
double usualMost(std::vector<double> values) {
    if (values.empty()) return 1.0;
    const auto most = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 19 / 20);
    std::nth_element(values.begin(), most, values.end());
    return std::max(*most, 1e-6);
}

std::vector<Colour> asColours(const std::vector<std::vector<double>>& values) {
    std::vector<Colour> colours(values.front().size());
    for (std::size_t i = 0; i < colours.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            colours[i][c] = static_cast<std::uint8_t>(
                std::lround(255.0 * std::clamp(values[c][i], 0.0, 1.0)));
    return colours;
}

/// Of what was measured, without the outermost hundredths.
std::pair<double, double> scaleOf(std::vector<double> measured) {
    std::sort(measured.begin(), measured.end());
    const std::size_t stray = measured.size() / 100;
    return {measured[stray], measured[measured.size() - 1 - stray]};
}

PointPicture pictureOf(const std::string& title, const std::string& file,
                       const ModalityView& shown, const View& view) {
    PointPicture picture;
    picture.title = title;
    picture.file = file + ".ply";
    picture.points.vertices = shown.points.points_map;
    picture.view = view;
    return picture;
}

bool isColour(const std::vector<std::string>& names) {
    return names == std::vector<std::string>{"r", "g", "b"};
}

}  // namespace

std::string modalityTable(const ModalityFindings& findings) {
    const Run& run = findings.run;
    std::string text =
        format("study table5.1: %s, %zu scans%s, %g %% of the points held out\n",
               run.dataset.c_str(), run.scansMapped,
               run.interrupted ? " (interrupted)" : "", 100 * run.split.holdoutPoints);
    if (!findings.scans.empty()) text += scansTable(findings);
    text += sequenceTable(findings);
    text += "  * mean squared errors, tenth of largest over tenth of smallest variance\n";
    if (isColour(findings.names))
        text +=
            "  thesis, one frame of FR_ROOM: r, g, b reconstructed .853, .851, .852; "
            "inferred .814, .803, .796\n";
    return text;
}

nlohmann::ordered_json modalityMetrics(const ModalityFindings& findings) {
    Json json = metricsJson(findings.run, {});
    json["study"] = "table5.1";
    json["modalities"] = findings.names;
    json["poor_share"] = kPoorShare;
    json["scans"] = Json::array();
    for (const ModalityMapResult& scan : findings.scans) {
        json["scans"].push_back(resultJson(scan));
        json["scans"].back()["scan"] = scan.scan;
    }
    json["sequence"] = resultJson(findings.sequence);
    json["scan_ms_with_modalities"] = findings.insertWith_ms;
    json["scan_ms_without_modalities"] = findings.insertWithout_ms;
    json["insertion_ratio"] = insertionRatio(findings);
    if (findings.query_us) json["cross_modal_query_us"] = *findings.query_us;
    return json;
}

std::vector<PointPicture> reconstructionPictures(const ModalityView& shown,
                                                 const std::string& name,
                                                 const View& view) {
    const ModalityPoints& points = shown.points;
    std::vector<std::vector<double>> means;
    for (const auto& estimates : shown.estimates) {
        means.emplace_back();
        for (const hgmm::ModalityEstimate& e : estimates) means.back().push_back(e.mean);
    }
    std::vector<PointPicture> pictures{
        pictureOf("As measured", name + "_measured", shown, view),
        pictureOf("As reconstructed", name + "_reconstructed", shown, view)};
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const auto& values = i == 0 ? points.values : means;
        PointPicture& picture = pictures[i];
        picture.caption = isColour(points.names) ? "Colours" : points.names.front();
        if (isColour(points.names)) {
            picture.points.colours = asColours(values);
        } else {
            picture.points.values.assign(values.front().begin(), values.front().end());
            picture.scale = scaleOf(points.values.front());
        }
    }
    return pictures;
}

std::vector<PointPicture> deviationPictures(const ModalityView& shown,
                                            const std::string& name, const View& view) {
    std::vector<PointPicture> pictures;
    double most = 0.0;
    for (std::size_t m = 0; m < shown.estimates.size(); ++m) {
        const std::string& modality = shown.points.names[m];
        pictures.push_back(pictureOf("Predicted standard deviation of " + modality,
                                     name + "_deviation_" + modality, shown, view));
        std::vector<double> deviations;
        for (const hgmm::ModalityEstimate& e : shown.estimates[m])
            deviations.push_back(std::sqrt(e.variance));
        pictures.back().points.values.assign(deviations.begin(), deviations.end());
        most = std::max(most, usualMost(std::move(deviations)));
    }
    for (PointPicture& picture : pictures) {
        picture.scale = {0.0, most};
        picture.caption = format("From dark at 0 to yellow at %.3g", most);
    }
    return pictures;
}

}  // namespace replay
