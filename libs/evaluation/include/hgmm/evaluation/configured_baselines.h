#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// The maps that an MRPT configuration file defines (`octoMap_count = 1` and the like, in
/// any section), but those of this project: each with a name such as "octoMap_00", or
/// "section/octoMap_00" if two sections have one. None for a file without maps.
///
/// What they answer with:
/// | class | answer |
/// | --- | --- |
/// | COctoMap, CColouredOctoMap, COccupancyGridMap3D | the voxel's occupancy |
/// | those of points | nearness, as NearestBaseline |
/// | others | surface likelihood: 1 / (1 + exp(-l)), with l the log-likelihood of an
/// observation of that one point; unknown where the class gives none |
///
/// Their options are the file's: a COccupancyGridMap3D keeps its size, and a map whose file
/// turns insertion off stays empty. liveBytes() is the map's own account if it has one,
/// else the size of its serialisation.
///
/// Throws std::runtime_error, naming the file, if it cannot be read or a map cannot be made
/// from it.
std::vector<std::pair<std::string, std::unique_ptr<Baseline>>> configuredBaselines(
    const std::string& file);

}  // namespace hgmm::evaluation
