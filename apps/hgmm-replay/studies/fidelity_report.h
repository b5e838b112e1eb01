#pragma once
#include <string>
#include <vector>

#include "studies/fidelity_study.h"

namespace replay {

/// Mean estimated size and spread over the frames, for a reader.
std::string fidelitySummary(const std::vector<FidelityCurve>& curves, std::size_t skipped);

/// Writes fig3.2.csv, and both divergences as plots of the report (writeReportFiles).
/// Throws std::runtime_error naming the file.
void writeFidelityReport(const std::vector<FidelityCurve>& curves, const Options& options);

}  // namespace replay
