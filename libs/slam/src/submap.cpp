#include "hgmm/slam/submap.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "hgmm/surface_distance.h"

namespace hgmm::slam {
namespace {

void require(bool holds, const char* field, const char* rule) {
    if (!holds) throw std::invalid_argument(std::string(field) + ": must be " + rule);
}

}  // namespace

void SubmapParams::validate() const {
    require(lengthPerRange > 0, "lengthPerRange", "positive");
    require(minLength_m > 0, "minLength_m", "positive");
    require(maxLength_m >= minLength_m, "maxLength_m", "at least minLength_m");
    require(maxTurn_rad > 0, "maxTurn_rad", "positive");
    require(minScans >= 1, "minScans", "at least 1");
}

Mixture<3> surfacesInMapFrame(const Map& map) {
    return transformed(map.mixture(), {Eigen::Matrix3d::Identity(), map.origin()});
}

SubmapShape::SubmapShape(const Submap& submap) {
    const Mixture<3> all = surfacesInMapFrame(submap.map);
    std::vector<std::size_t> solid;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all.support[i] >= kSurfaceSupport) solid.push_back(i);
    const std::size_t count = std::min(solid.size(), kMost);
    for (std::size_t k = 0; k < count; ++k)
        surfaces_submap.pushBack(all[solid[k * solid.size() / count]]);
    if (count == 0) return;

    for (std::size_t i = 0; i < count; ++i)
        centre_submap += Eigen::Vector3d(surfaces_submap[i].mean);
    centre_submap /= static_cast<double>(count);
    std::vector<double> distances_m;
    for (std::size_t i = 0; i < count; ++i)
        distances_m.push_back(
            (Eigen::Vector3d(surfaces_submap[i].mean) - centre_submap).norm());
    const auto ninth = distances_m.begin() + static_cast<std::ptrdiff_t>(count * 9 / 10);
    std::nth_element(distances_m.begin(), ninth, distances_m.end());
    radius_m = *ninth;
    appearance = Appearance(surfaces_submap, Eigen::Vector3d::Zero());
}

}  // namespace hgmm::slam
