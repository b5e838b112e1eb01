#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "commands.h"
#include "hgmm/map.h"

namespace maptool {

/// What a map says about points.
struct QueryAnswers {
    std::vector<Eigen::Vector3d> points_map;  ///< [m]
    std::vector<hgmm::Occupancy> occupancy;
    bool hasDistance = false;                     ///< whether it was asked for
    std::vector<hgmm::SurfaceDistance> distance;  ///< none if not
    std::vector<std::string> modalityNames;
    /// By modality, then point.
    std::vector<std::vector<hgmm::ModalityEstimate>> modalities;
};

/// "occupied", "free" or "unknown", by the largest of the three probabilities; unknown
/// where there is a draw.
const char* verdict(const hgmm::Occupancy& answer);

/// Whether there is a distance along the rays. One to a surface that nobody has seen would
/// mean nothing; the variance is 0 where no component gives one.
bool hasAlongRay(const hgmm::Occupancy& answer);

/// A header and a line for each point, in columns that are parted by blanks.
std::string listingOf(const QueryAnswers& answers);
/// A header and a row for each point. What is not known is empty.
std::string csvOf(const QueryAnswers& answers);
/// An object for each point and line, with the names of the columns of csvOf. What is not
/// known is null.
std::string jsonLinesOf(const QueryAnswers& answers);

}  // namespace maptool
