#pragma once
#include <mrpt/opengl/CSetOfObjects.h>

#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/render_params.h"

namespace hgmm::mrpt_bridge {

/// Appends one ellipsoid per surface component, or per component of the modality that
/// colours show, in the map frame, unless drawEllipsoids is false.
void appendEllipsoids(const Map& map, const RenderParams& params,
                      mrpt::opengl::CSetOfObjects& objects);

/// Appends one translucent ellipsoid per free-space component if drawFreeSpace is true:
/// where rays passed, whatever their distance to the surface.
void appendFreeSpace(const Map& map, const RenderParams& params,
                     mrpt::opengl::CSetOfObjects& objects);

}  // namespace hgmm::mrpt_bridge
