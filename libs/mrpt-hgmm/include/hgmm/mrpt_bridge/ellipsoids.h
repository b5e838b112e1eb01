#pragma once
#include <mrpt/opengl/CSetOfObjects.h>

#include "hgmm/map.h"

namespace hgmm::mrpt_bridge {

/// How a map is drawn.
struct RenderParams {
    double sigmas = 2.0;  ///< size of the ellipsoids [sigma], 0.01 to 10
    int level = 0;  ///< level of the hierarchy, 0 the finest; beyond the last: the last
    int maxEllipsoids = 10000;  ///< only those with most support are drawn [count], >= 1
    bool colourByWeight =
        false;  ///< colour shows the logarithm of the weight, else the height

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// Appends one ellipsoid per component, in the map frame.
void appendEllipsoids(const Map& map, const RenderParams& params,
                      mrpt::opengl::CSetOfObjects& objects);

}  // namespace hgmm::mrpt_bridge
