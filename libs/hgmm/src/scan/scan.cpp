#include "hgmm/scan.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/require_rigid.h"

namespace hgmm {

namespace {

void requireSound(const ClearedRay& ray, std::size_t i) {
    constexpr float tolerance = 1e-3F;
    const auto refuse = [i](const char* why) {
        throw std::invalid_argument("Scan: cleared ray " + std::to_string(i) + why);
    };
    if (!(std::abs(ray.direction.norm() - 1.F) <= tolerance))
        refuse(": its direction is not of unit length");
    if (!std::isfinite(ray.length_m) || ray.length_m < 0.F)
        refuse(": its length is negative or not finite");
}

}  // namespace

void Scan::reserve(std::size_t n) {
    x.reserve(n);
    y.reserve(n);
    z.reserve(n);
}

void Scan::pushBack(float px, float py, float pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
}

void Scan::validate() const {
    if (y.size() != x.size() || z.size() != x.size())
        throw std::invalid_argument("Scan: x, y and z differ in length");
    for (const Channel& channel : channels)
        if (channel.values.size() != x.size())
            throw std::invalid_argument("Scan: channel '" + channel.name +
                                        "' does not hold one value per point");
    requireRigid(T_map_sensor, "Scan: the sensor pose");
    for (std::size_t i = 0; i < clearedRays.size(); ++i) requireSound(clearedRays[i], i);
}

}  // namespace hgmm
