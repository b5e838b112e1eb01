#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/picture.h"
#include "hgmm/evaluation/render.h"
#include "studies/modality_study.h"

namespace replay {

/// The findings for a reader.
std::string modalityTable(const ModalityFindings& findings);

/// The findings as metrics.json.
std::string modalityMetrics(const ModalityFindings& findings);

/// The points as measured, and beside them as reconstructed: r, g and b together, or the
/// first modality from dark blue at its lowest to yellow.
hgmm::evaluation::Picture reconstructionPicture(const ModalityView& shown,
                                                const hgmm::evaluation::View& view);

/// The predicted standard deviation of each modality, from dark blue at 0 to yellow, beside
/// each other and on one scale (thesis fig. 5.1 c to e).
hgmm::evaluation::Picture variancePicture(const ModalityView& shown,
                                          const hgmm::evaluation::View& view);

}  // namespace replay
