#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/modality_figures.h"
#include "hgmm/evaluation/recording.h"
#include "options.h"
#include "studies/modality_evaluation.h"

namespace replay {

/// Share of the points that is held out, unless --holdout-points says so.
constexpr double kModalityHoldout = 0.2;
/// Share of the points that a poor model learns from (thesis 5.3.2).
constexpr double kPoorShare = 0.1;

/// What the study finds.
struct ModalityFindings {
    hgmm::evaluation::Run run;
    std::vector<std::string> names;
    std::vector<ModalityMapResult> scans;  ///< of some scans, evenly over the recording
    ModalityMapResult sequence;            ///< of all scans
    std::vector<double> insertWith_ms, insertWithout_ms;  ///< of each scan
    std::optional<double> query_us;  ///< cross-modal, on the map of all scans
};

/// Points to be looked at, as measured and as the map says.
struct ModalityView {
    hgmm::evaluation::ModalityPoints points;
    ModalityEstimates estimates;
};

/// Thesis table 5.1 and fig. 5.1: reconstruction of modalities (r, g and b, or intensity,
/// or what --config names) at held-out points by maps of one scan and of all; for colours,
/// each inferred from the two others. Prints a table and writes metrics.json and pictures
/// into the report folder, if there is one. Throws std::runtime_error naming the recording
/// if it has none of the modalities.
void modalityStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
