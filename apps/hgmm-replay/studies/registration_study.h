#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Registration of pairs of scans from guesses that are 0.5 m and 10 deg off: success rate,
/// errors and times. Throws std::runtime_error naming the recording if it has no pair.
void registrationStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
