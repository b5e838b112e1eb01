#include "hgmm/scan.h"

#include <Eigen/LU>

#include <cmath>
#include <stdexcept>

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
    const Eigen::Matrix3d& R = T_map_sensor.R;
    if (!R.allFinite() || !T_map_sensor.t.allFinite())
        throw std::invalid_argument("Scan: the sensor pose is not finite");
    if (!(R * R.transpose()).isIdentity(1e-4) || R.determinant() < 0)
        throw std::invalid_argument("Scan: the sensor pose's rotation is not orthonormal");
}

}  // namespace hgmm
