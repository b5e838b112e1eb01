#pragma once
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/render_params.h"

namespace hgmm::mrpt_bridge {

/// Colour of a voxel under the conventions of mrpt::maps::COctoMap.
/// @param general colour of the whole object, which the mode modulates
/// @param probability of being occupied, in [0, 1]
/// @param height share of the way from the lowest to the highest voxel, in [0, 1]
mrpt::img::TColor voxelColour(mrpt::opengl::COctoMapVoxels::visualization_mode_t mode,
                              const mrpt::img::TColorf& general, double probability,
                              double height);

/// Implements CHGMMOccupancyMap::getAsOctoMapVoxels. If params.colour is kModality, the
/// mode modulates the colour of the modality in each occupied voxel.
void fillOctoMapVoxels(const Map& map, const RenderParams& params,
                       mrpt::opengl::COctoMapVoxels& target);

/// Appends voxels, coloured by height or modality, if drawVoxels is true.
void appendVoxels(const Map& map, const RenderParams& params,
                  mrpt::opengl::CSetOfObjects& objects);

}  // namespace hgmm::mrpt_bridge
