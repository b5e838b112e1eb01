#pragma once
#include <vector>

namespace hgmm::evaluation {

/// Times of a run [ms] (protocol, step 6).
struct Timing {
    double median = 0.0;
    double p99 = 0.0;  ///< nearest rank
    double worst = 0.0;
    double firstTenth = 0.0;  ///< median of the first tenth of the run, at least one scan
    double lastTenth = 0.0;   ///< median of the last tenth: against firstTenth, the trend
};

/// Summarises durations given in the order of the run; all zero for an empty run.
Timing summariseTimes(const std::vector<double>& durations_ms);

/// The middle value, or the mean of the two in the middle; 0 for none.
double median(std::vector<double> values);

}  // namespace hgmm::evaluation
