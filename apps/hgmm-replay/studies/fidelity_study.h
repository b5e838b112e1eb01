#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "hgmm/evaluation/recording.h"
#include "hgmm/params.h"
#include "options.h"

namespace replay {

/// One point of the curves of thesis fig. 3.2.
struct FidelityPoint {
    std::size_t size = 0;        ///< components
    double similarity = 0.0;     ///< lambda_d of the merge pass that made it [nat]
    double kl = 0.0;             ///< KL(largest || this) [nat]
    double cauchySchwarz = 0.0;  ///< [nat]
};

/// The reduction of one frame's mixture.
struct FidelityCurve {
    std::size_t frame = 0;              ///< scan index
    std::vector<FidelityPoint> points;  ///< sizes falling, [0] is the overestimate
    std::size_t knee = 0;               ///< index of the estimated fidelity threshold
};

/// Components of the overestimate, thesis 3.3.2.
constexpr std::size_t kOverestimate = 300;

/// Reduces one scan's mixture from about kOverestimate components, the cells of its first
/// guess being sized to that end. Throws std::invalid_argument if the scan has too few
/// points.
FidelityCurve fidelityCurve(const hgmm::Scan& scan, const hgmm::MapParams& params);

/// Estimates the fidelity threshold of every scan, prints the mean (thesis: 116 for the
/// room) and writes fig3.2.csv, metrics.json and report.html into the report folder, if
/// there is one.
void fidelityStudy(hgmm::evaluation::Recording& recording, const hgmm::MapParams& params,
                   const Options& options);

}  // namespace replay
