#pragma once
#include <string>
#include <vector>

#include "studies/regression_study.h"

namespace replay {

/// Table of the first run, and how the others ended, for a reader.
/// @param runs at least one; the first queried after each set
std::string regressionSummary(const std::vector<RegressionRun>& runs);

/// Writes metrics.json and fig4.5_{mixture,gp,entropy,variance,first,last}.svg. Throws
/// std::runtime_error naming the file.
void writeRegressionReport(const std::vector<RegressionRun>& runs,
                           const std::string& folder);

}  // namespace replay
