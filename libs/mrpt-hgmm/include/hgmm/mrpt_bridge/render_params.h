#pragma once
#include <string>

#include "hgmm/option.h"

namespace hgmm::mrpt_bridge {

/// What the colour of an ellipsoid shows, from blue to red but for kModality.
enum class EllipsoidColour : int {
    kHeight = 0,     ///< of its mean, from the lowest to the highest drawn
    kWeight = 1,     ///< logarithm of its weight, from the lightest to the heaviest drawn
    kOccupied = 2,   ///< P(occ) at its mean, from 0 to 1 (thesis eq. 4.15)
    kDeviation = 3,  ///< sqrt(Var[W]) at its mean, from the surest to the least sure drawn
    kModality = 4,   ///< what RenderParams::modality names; also of occupied voxels
};

/// How a map is drawn: as ellipsoids and as voxels.
struct RenderParams {
    int level = 0;  ///< level of the hierarchy, 0 the finest; beyond the last: the last

    bool drawEllipsoids = true;  ///< the surface components
    bool drawFreeSpace = false;  ///< free-space components, as translucent ellipsoids
    bool drawVoxels = false;     ///< cubes, as getAsOctoMapVoxels makes them
    double sigmas = 2.0;         ///< size of the ellipsoids [sigma], 0.01 to 10
    int maxEllipsoids = 10000;   ///< only those with most support are drawn [count], >= 1
    /// EllipsoidColour: 0 height, 1 weight, 2 P(occ), 3 deviation, 4 modality
    int colour = 0;
    /// What is shown if colour is 4: "rgb" as it was measured, or another modality of the
    /// map from blue to red; empty: rgb if the map has it, else its first. Grey where
    /// unknown.
    std::string modality;

    double voxelResolution_m = 0.0;  ///< edge of voxels [m]; 0: derived from the map
    double minOccupied = 0.5;        ///< P(occ) of an occupied voxel [1], 0.01 to 0.99
    bool generateOccupiedVoxels = true;
    bool visibleOccupiedVoxels = true;  ///< has no effect on voxels not generated
    bool generateFreeVoxels = true;
    bool visibleFreeVoxels = true;   ///< has no effect on voxels not generated
    bool generateGridLines = false;  ///< edges of all voxels

    /// Throws std::invalid_argument naming the field.
    void validate() const;
    static const OptionTable<RenderParams>& options();
    bool operator==(const RenderParams& o) const;
};

}  // namespace hgmm::mrpt_bridge
