#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hgmm/evaluation/modality_figures.h"
#include "hgmm/map.h"

namespace replay {

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
    std::size_t modalityBytes = 0;             ///< of all modalities together
    std::size_t mapBytes = 0;                  ///< of the whole saved map
    std::vector<CrossModalResult> crossModal;  ///< for maps of one scan with r, g and b
};

/// By modality, then point.
using ModalityEstimates = std::vector<std::vector<hgmm::ModalityEstimate>>;

ModalityEstimates estimatesAt(const hgmm::Map& map,
                              const hgmm::evaluation::ModalityPoints& points);

/// As users will have it: loaded from the bytes that are counted.
hgmm::Map savedAndLoaded(const hgmm::Map& map);

/// Reconstruction at held-out points, and sizes; no cross-modal results.
/// @param estimates of the map at the test points
ModalityMapResult evaluateModalities(const hgmm::Map& map,
                                     const hgmm::evaluation::ModalityPoints& test,
                                     const ModalityEstimates& estimates);

/// Inference of modality number `target` from the others at the first points of `test`, of
/// which there must be one.
CrossModalResult inferAt(const hgmm::Map& map, const hgmm::evaluation::ModalityPoints& test,
                         std::size_t target);

/// The points in random order: each is equally likely to be among the first.
hgmm::evaluation::ModalityPoints shuffled(const hgmm::evaluation::ModalityPoints& points,
                                          std::uint64_t seed);

}  // namespace replay
