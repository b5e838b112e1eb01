#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// One way to model the mapping scans, and how well it explains the test points.
struct ModelLikelihood {
    std::string model;
    std::size_t components = 0;
    double logLikelihood = 0.0;  ///< of held-out hits [nat/point]
};

/// What incremental updates cost.
struct IncrementalComparison {
    std::vector<ModelLikelihood> models;  ///< [0] is the incremental map
    std::size_t samples = 0;              ///< that the batch models were fitted to
    double leaf_m = 0.0;                  ///< edge of the leaves they were merged in [m]
};

/// Compares the map built scan by scan with mixtures of as many components that EM fits to
/// the samples of all mapping scans at once: from cells, and from the map's own components.
/// Prints a table and writes incremental.csv into the report folder, if there is one.
/// Ctrl-C ends it without a result. Throws std::runtime_error if there are no mapping scans
/// or no test points.
void incrementalStudy(hgmm::evaluation::Recording& recording,
                      const hgmm::evaluation::RecordingOptions& recordingOptions,
                      const Options& options);

}  // namespace replay
