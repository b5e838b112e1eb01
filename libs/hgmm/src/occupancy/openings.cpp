#include "occupancy/openings.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hgmm {

namespace {

/// A ray is aside by so much: at 1 m, growing with the root of the range [m], and of the
/// range [1].
constexpr double kAsideAtOneMetre_m = 0.01, kAsidePerMetre = 0.005;

}  // namespace

void Openings::learn(Coverage passed, const Mixture<3>& hits,
                     const Eigen::Vector3d& sensorOrigin, const Coverage::Rays& rays) {
    if (passed.empty() && empty()) return;
    const Coverage all = passed;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Eigen::Vector3d hit = hits[i].mean;
        const double range_m = (hit - sensorOrigin).norm();
        const Eigen::Vector3d around = Eigen::Vector3d::Constant(
            std::max(powerOfTwo(octaveAt(range_m, rays)) / 2,
                     kAsideAtOneMetre_m * std::sqrt(range_m) + kAsidePerMetre * range_m));
        const Eigen::AlignedBox3d box(hit - around, hit + around);
        passed.clear(box);
        once_.clear(box);
        cells_.clear(box, all);
    }
    passed.forEachBlock([&](const LatticeCell& block, Coverage::Word cells) {
        const Coverage::Word before = once_.word(block);
        cells_.mark(block, cells & before);
        once_.mark(block, cells);
    });
}

}  // namespace hgmm
