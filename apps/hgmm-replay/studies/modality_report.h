#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report_page.h"
#include "studies/modality_study.h"

namespace replay {

/// The findings for a reader.
std::string modalityTable(const ModalityFindings& findings);

/// The findings as metrics.json.
nlohmann::ordered_json modalityMetrics(const ModalityFindings& findings);

/// The points as measured, and as reconstructed: r, g and b together, or the first
/// modality from dark at its lowest to yellow.
/// @param name of the study's files
std::vector<PointPicture> reconstructionPictures(const ModalityView& shown,
                                                 const std::string& name, const View& view);

/// The predicted standard deviation of each modality, all on one scale (thesis fig. 5.1 c
/// to e).
/// @param name of the study's files
std::vector<PointPicture> deviationPictures(const ModalityView& shown,
                                            const std::string& name, const View& view);

}  // namespace replay
