#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/modality_figures.h"
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

constexpr double kModalityHoldout = 0.2;  ///< of the points, unless --holdout-points is given
constexpr double kPoorShare = 0.1;        ///< of the points, for a poor model (thesis 5.3.2)

/// A modality as a map reconstructs it at held-out points.
struct ModalityResult {
    std::string name;
    hgmm::evaluation::ModalityScore score;
    std::size_t components = 0;
    std::size_t bytes = 0;  ///< that it adds to the saved map
};

/// A modality learnt from few of the points, at held-out points.
struct CrossModalResult {
    std::string target;
    double r2Inferred = 0.0;   ///< from the values of the other modalities there (5.14)
    double r2Regressed = 0.0;  ///< from the poor model alone (5.6)
    double query_us = 0.0;     ///< of one inference, on one thread
};

/// What one map says, and how large it is.
struct ModalityMapResult {
    std::size_t scan = 0;  ///< for a map of one scan: which
    std::vector<ModalityResult> modalities;
    std::size_t modalityBytes = 0;  ///< of all modalities together
    std::size_t mapBytes = 0;       ///< of the whole saved map
    std::vector<CrossModalResult> crossModal;  ///< for maps of one scan with r, g and b
};

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
    std::vector<std::vector<hgmm::ModalityEstimate>> estimates;  ///< by modality, then point
};

/// Thesis table 5.1 and fig. 5.1: reconstruction of modalities (r, g and b, or intensity, or
/// what --config names) at held-out points by maps of one scan and of all; for colours,
/// each inferred from the two others. Prints a table and writes metrics.json and pictures
/// into the report folder, if there is one. Throws std::runtime_error naming the recording
/// if it has none of the modalities.
void modalityStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
