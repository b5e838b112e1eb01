#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hgmm/evaluation/points.h"
#include "hgmm/modality.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// Points with the values that were measured there.
struct ModalityPoints {
    std::vector<std::string> names;
    Points points_map;                        ///< [m]
    std::vector<std::vector<double>> values;  ///< of each name, one per point

    std::size_t size() const { return points_map.size(); }
};

/// Appends those of the points named by `indices` that are finite and where all modalities
/// were measured; none of a scan that lacks one.
void appendMeasured(const Scan& scan, const std::vector<std::size_t>& indices,
                    ModalityPoints& points);

/// Leaves a channel's value at a share of the points, chosen by (seed, scanIndex), and
/// makes it "not measured" at the others. Channels of other names stay.
void keepShare(Scan& scan, const std::string& channel, double share, std::uint64_t seed,
               std::size_t scanIndex);

/// How well estimates agree with what was measured.
struct ModalityScore {
    std::size_t points = 0;
    double knownShare = 0.0;  ///< of the points, [0, 1]
    double r2 = 0.0;          ///< coefficient of determination, at most 1; 0 for no points
    double mse = 0.0;         ///< mean squared error [unit squared]
    /// Mean squared errors of the tenths of the points with the least and the most
    /// predicted variance [unit squared].
    double mseOfSurest = 0.0, mseOfLeastSure = 0.0;
};

/// Compares estimates at points with the values there; unknown ones count like others, by
/// the mean that they give. A constant truth has R^2 = 1 if it is met, else 0. Throws
/// std::invalid_argument if the two differ in length.
ModalityScore scoreOf(const std::vector<ModalityEstimate>& estimates,
                      const std::vector<double>& measured);

}  // namespace hgmm::evaluation
