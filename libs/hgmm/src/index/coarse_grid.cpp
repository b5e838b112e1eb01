#include "index/coarse_grid.h"

#include <algorithm>

namespace hgmm {

void CoarseGrid::add(std::uint32_t i, const Eigen::Vector3f& mean) {
    PoolRun& run = *cells_.tryEmplace(cellOf(mean), PoolRun{}).first;
    members_.insert(run, run.count, i);
}

void CoarseGrid::remove(std::uint32_t i, const Eigen::Vector3f& mean) {
    const LatticeCell cell = cellOf(mean);
    PoolRun& run = *cells_.tryEmplace(cell, PoolRun{}).first;
    const std::uint32_t* const first = members_.data(run);
    const std::uint32_t* const member = std::find(first, first + run.count, i);
    if (member != first + run.count)
        members_.erase(run, static_cast<std::uint32_t>(member - first));
    if (run.count == 0) cells_.erase(cell);
}

std::vector<std::uint32_t> CoarseGrid::within(const Eigen::Vector3d& low,
                                              const Eigen::Vector3d& high) const {
    std::vector<std::uint32_t> found;
    const LatticeCell a = LatticeCell::at(low, kOctave), b = LatticeCell::at(high, kOctave);
    const auto take = [&](const PoolRun& run) {
        const std::uint32_t* const first = members_.data(run);
        found.insert(found.end(), first, first + run.count);
    };
    const double cells =
        (double(b.x) - a.x + 1) * (double(b.y) - a.y + 1) * (double(b.z) - a.z + 1);
    if (cells > double(cells_.size())) {
        cells_.forEach([&](const LatticeCell& c, const PoolRun& run) {
            if (c.x >= a.x && c.x <= b.x && c.y >= a.y && c.y <= b.y && c.z >= a.z &&
                c.z <= b.z)
                take(run);
        });
    } else {
        LatticeCell c = a;
        for (c.x = a.x; c.x <= b.x; ++c.x)
            for (c.y = a.y; c.y <= b.y; ++c.y)
                for (c.z = a.z; c.z <= b.z; ++c.z) {
                    const PoolRun* const run = cells_.find(c);
                    if (run != nullptr) take(*run);
                }
    }
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace hgmm
