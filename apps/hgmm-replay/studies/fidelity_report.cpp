#include "studies/fidelity_report.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "hgmm/evaluation/plot.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "report_page.h"

namespace replay {
namespace {

using hgmm::evaluation::Curve;

/// Linear interpolation of one curve at a size between its ends.
double valueAt(const FidelityCurve& curve, double size, double FidelityPoint::*value) {
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        const FidelityPoint &above = curve.points[i - 1], &below = curve.points[i];
        if (size < double(below.size)) continue;
        if (above.size == below.size) return below.*value;
        const double share =
            (size - double(below.size)) / (double(above.size) - double(below.size));
        return below.*value + share * (above.*value - below.*value);
    }
    return curve.points.back().*value;
}

/// Mean over the frames at the sizes that all of them have.
Curve meanCurve(const std::vector<FidelityCurve>& curves, double FidelityPoint::*value) {
    double low = 0.0, high = 1e9;
    for (const FidelityCurve& curve : curves) {
        low = std::max(low, double(curve.points.back().size));
        high = std::min(high, double(curve.points.front().size));
    }
    Curve mean{{}, "mean of " + std::to_string(curves.size()) + " frames", true};
    for (double size = low; size <= high; ++size) {
        double sum = 0.0;
        for (const FidelityCurve& curve : curves) sum += valueAt(curve, size, value);
        mean.points.emplace_back(size, sum / double(curves.size()));
    }
    return mean;
}

nlohmann::ordered_json divergencePlot(const std::vector<FidelityCurve>& curves,
                                      const std::string& name,
                                      double FidelityPoint::*value) {
    hgmm::evaluation::Plot plot{
        name + " divergence from the largest mixture (thesis fig. 3.2)",
        "size of the mixture [components]",
        name + " divergence [nat]",
        {}};
    for (const FidelityCurve& curve : curves) {
        Curve& line = plot.curves.emplace_back();
        for (const FidelityPoint& p : curve.points)
            line.points.emplace_back(double(p.size), p.*value);
    }
    plot.curves.push_back(meanCurve(curves, value));
    return plotJson(plot);
}

std::string csv(const std::vector<FidelityCurve>& curves) {
    std::ostringstream out;
    out << "frame,components,similarity_nat,kl_nat,cauchy_schwarz_nat,is_fidelity_"
           "threshold\n";
    for (const FidelityCurve& curve : curves)
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const FidelityPoint& p = curve.points[i];
            out << curve.frame << ',' << p.size << ',' << p.similarity << ',' << p.kl << ','
                << p.cauchySchwarz << ',' << (i == curve.knee ? 1 : 0) << '\n';
        }
    return out.str();
}

}  // namespace

std::string fidelitySummary(const std::vector<FidelityCurve>& curves, std::size_t skipped) {
    std::vector<double> sizes;
    double sum = 0.0, overestimates = 0.0;
    for (const FidelityCurve& curve : curves) {
        sizes.push_back(double(curve.points[curve.knee].size));
        sum += sizes.back();
        overestimates += double(curve.points.front().size);
    }
    const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
    const double n = double(sizes.size());
    char text[320];
    std::snprintf(
        text, sizeof text,
        "study fig3.2: %zu frames (%zu left out), overestimate %.1f components on "
        "average\nestimated fidelity threshold: mean %.1f components, median %.1f, "
        "from %.0f to %.0f (thesis, cluttered room: 116)\n",
        sizes.size(), skipped, overestimates / n, sum / n, hgmm::evaluation::median(sizes),
        *least, *most);
    return text;
}

void writeFidelityReport(const std::vector<FidelityCurve>& curves, const Options& options) {
    hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/fig3.2.csv", csv(curves));
    writeReportFiles(
        {{"study", "fig3.2"},
         {"plots",
          {divergencePlot(curves, "KL", &FidelityPoint::kl),
           divergencePlot(curves, "Cauchy-Schwarz", &FidelityPoint::cauchySchwarz)}}},
        options);
}

}  // namespace replay
