#include "index/coarse_grid.h"

#include <algorithm>

namespace hgmm {

void CoarseGrid::leave(std::uint32_t i) {
    const auto entry = members_.find(cellOf_[i]);
    auto& members = entry->second;
    members.erase(std::find(members.begin(), members.end(), i));
    if (members.empty()) members_.erase(entry);
}

void CoarseGrid::update(std::uint32_t i, const Eigen::Vector3d& mean) {
    const LatticeCell cell = LatticeCell::at(mean, kOctave);
    if (i == cellOf_.size()) {
        cellOf_.push_back(cell);
    } else {
        if (cellOf_.at(i) == cell) return;
        leave(i);
        cellOf_[i] = cell;
    }
    members_[cell].push_back(i);
}

void CoarseGrid::truncate(std::size_t n) {
    for (; size() > n; cellOf_.pop_back()) leave(static_cast<std::uint32_t>(size() - 1));
}

std::vector<std::uint32_t> CoarseGrid::within(const Eigen::Vector3d& low,
                                              const Eigen::Vector3d& high) const {
    std::vector<std::uint32_t> found;
    const LatticeCell a = LatticeCell::at(low, kOctave), b = LatticeCell::at(high, kOctave);
    const auto take = [&](const std::vector<std::uint32_t>& members) {
        found.insert(found.end(), members.begin(), members.end());
    };
    const double cells =
        (double(b.x) - a.x + 1) * (double(b.y) - a.y + 1) * (double(b.z) - a.z + 1);
    if (cells > double(members_.size())) {
        for (const auto& [c, members] : members_)
            if (c.x >= a.x && c.x <= b.x && c.y >= a.y && c.y <= b.y && c.z >= a.z &&
                c.z <= b.z)
                take(members);
    } else {
        LatticeCell c = a;
        for (c.x = a.x; c.x <= b.x; ++c.x)
            for (c.y = a.y; c.y <= b.y; ++c.y)
                for (c.z = a.z; c.z <= b.z; ++c.z) {
                    const auto entry = members_.find(c);
                    if (entry != members_.end()) take(entry->second);
                }
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::size_t CoarseGrid::liveBytes() const {
    std::size_t bytes =
        cellOf_.capacity() * sizeof(LatticeCell) + members_.bucket_count() * sizeof(void*);
    for (const auto& entry : members_)
        bytes += sizeof(entry) + 2 * sizeof(void*) +
                 entry.second.capacity() * sizeof(std::uint32_t);
    return bytes;
}

}  // namespace hgmm
