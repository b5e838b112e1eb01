#include "studies/fidelity_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "hgmm/divergence.h"
#include "hgmm/em.h"
#include "hgmm/hierarchy.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/scan.h"
#include "interrupt.h"
#include "progress.h"
#include "studies/fidelity_report.h"

namespace replay {
namespace {

/// The first guess whose size is nearest to kOverestimate, by bisection on the logarithm of
/// the cell size: smaller cells, more components.
hgmm::InitialMixture overestimate(const hgmm::Mixture<3>& samples, hgmm::CellParams cells) {
    double low = std::log(1e-3), high = std::log(2.0);
    hgmm::InitialMixture best;
    const auto error = [](const hgmm::InitialMixture& m) {
        return std::abs(static_cast<double>(m.mixture.size()) - double(kOverestimate));
    };
    cells.minCell_m = std::min(cells.minCell_m, 0.01);
    for (int step = 0; step < 24 && (best.mixture.empty() || error(best) > 0.0); ++step) {
        const double middle = 0.5 * (low + high);
        cells.cellAtOneMetre_m = std::exp(middle);
        hgmm::InitialMixture guess =
            hgmm::initialiseFromCells(samples, Eigen::Vector3d::Zero(), cells);
        (guess.mixture.size() > kOverestimate ? low : high) = middle;
        if (best.mixture.empty() || error(guess) < error(best)) best = std::move(guess);
    }
    return best;
}

}  // namespace

FidelityCurve fidelityCurve(const hgmm::Scan& scan, const hgmm::MapParams& params) {
    const hgmm::Mixture<3> samples = hgmm::filterScan(scan, params.filter);
    if (samples.size() < 2 * kOverestimate)
        throw std::invalid_argument("only " + std::to_string(samples.size()) +
                                    " samples: too few for a mixture of " +
                                    std::to_string(kOverestimate));
    const hgmm::InitialMixture initial = overestimate(samples, params.cells);
    const hgmm::Mixture<3> reference =
        hgmm::fitSparse(samples, initial.mixture, initial.neighbourhoods, params.em)
            .mixture;
    const hgmm::Hierarchy<3> hierarchy =
        hgmm::generateHierarchy(reference, params.hierarchy);

    FidelityCurve curve;
    curve.knee = hierarchy.knee;
    // The hierarchy keeps the mixtures above the knee only, so the passes are made once
    // more.
    hgmm::Mixture<3> reduced = reference;
    for (const hgmm::DivergencePoint& point : hierarchy.curve) {
        if (point.size != reduced.size())
            reduced = hgmm::mergePass(reduced, point.similarity);
        curve.points.push_back({point.size, point.similarity, point.divergence,
                                hgmm::cauchySchwarzDivergence(reference, reduced)});
    }
    return curve;
}

void fidelityStudy(hgmm::evaluation::Recording& recording, const hgmm::MapParams& params,
                   const Options& options) {
    std::vector<FidelityCurve> curves;
    std::size_t skipped = 0;
    Progress progress(recording.size(), options.quiet);
    while (const auto recorded = recording.next()) {
        if (interrupted()) break;
        const auto scan = hgmm::mrpt_bridge::observationToScan(*recorded->observation);
        try {
            curves.push_back(fidelityCurve(scan.value_or(hgmm::Scan{}), params));
            curves.back().frame = recorded->index;
        } catch (const std::invalid_argument& e) {
            if (++skipped == 1)
                std::fprintf(stderr, "scan %zu left out: %s\n", recorded->index, e.what());
        }
        progress.advance();
    }
    if (curves.empty())
        throw std::runtime_error(options.log +
                                 ": no scan is dense enough for study fig3.2");
    std::fputs(fidelitySummary(curves, skipped).c_str(), stdout);
    if (options.reportFolder) writeFidelityReport(curves, options);
}

}  // namespace replay
