#pragma once
#include <string>
#include <vector>

#include "studies/regression_study.h"

namespace replay {

/// Table of the first run, and how the others ended, for a reader.
/// @param runs at least one; the first queried after each set
std::string regressionSummary(const std::vector<RegressionRun>& runs);

/// Writes the figures and the plots of fig. 4.5 as a report (writeReportFiles). Throws
/// std::runtime_error naming the file.
void writeRegressionReport(const std::vector<RegressionRun>& runs, const Options& options);

}  // namespace replay
