#include "studies/modality_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

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

std::vector<Rgb> asColours(const std::vector<std::vector<double>>& values) {
    std::vector<Rgb> colours(values.front().size());
    for (std::size_t i = 0; i < colours.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            colours[i][c] = std::clamp(values[c][i], 0.0, 1.0);
    return colours;
}

/// On the scale of what was measured, without the outermost hundredths.
std::vector<Rgb> onScale(const std::vector<double>& values, std::vector<double> measured) {
    std::sort(measured.begin(), measured.end());
    const double low = measured[measured.size() / 100];
    const double high = measured[measured.size() - 1 - measured.size() / 100];
    std::vector<Rgb> colours;
    colours.reserve(values.size());
    for (const double v : values)
        colours.push_back(scaleColour((v - low) / std::max(high - low, 1e-9)));
    return colours;
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

std::string modalityMetrics(const ModalityFindings& findings) {
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
    return json.dump(2) + "\n";
}

Picture reconstructionPicture(const ModalityView& shown, const View& view) {
    const ModalityPoints& points = shown.points;
    std::vector<std::vector<double>> means;
    for (const auto& estimates : shown.estimates) {
        means.emplace_back();
        for (const hgmm::ModalityEstimate& e : estimates) means.back().push_back(e.mean);
    }
    const Frame frame = frameOf(points.points_map, view);
    const auto draw = [&](const std::vector<std::vector<double>>& values) {
        return renderPoints(points.points_map,
                            isColour(points.names)
                                ? asColours(values)
                                : onScale(values.front(), points.values.front()),
                            view, frame);
    };
    return besideEachOther({draw(points.values), draw(means)});
}

Picture variancePicture(const ModalityView& shown, const View& view) {
    std::vector<std::vector<double>> deviations;
    double most = 0.0;
    for (const auto& estimates : shown.estimates) {
        deviations.emplace_back();
        for (const hgmm::ModalityEstimate& e : estimates)
            deviations.back().push_back(std::sqrt(e.variance));
        most = std::max(most, usualMost(deviations.back()));
    }
    const Frame frame = frameOf(shown.points.points_map, view);
    std::vector<Picture> pictures;
    for (const std::vector<double>& ofModality : deviations) {
        std::vector<Rgb> colours;
        for (const double d : ofModality) colours.push_back(scaleColour(d / most));
        pictures.push_back(renderPoints(shown.points.points_map, colours, view, frame));
    }
    return besideEachOther(pictures);
}

}  // namespace replay
