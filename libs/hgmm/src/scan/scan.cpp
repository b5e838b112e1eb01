#include "hgmm/scan.h"

#include <stdexcept>

#include "base/require_rigid.h"

namespace hgmm {

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
}

}  // namespace hgmm
