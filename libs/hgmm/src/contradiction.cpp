#include "hgmm/contradiction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hgmm/require.h"

namespace hgmm {

void ContradictionParams::validate() const {
    requireInRange("contradictedKeep", contradictedKeep, 1e-6, 1.0);
    requireInRange("minSupport", minSupport, 0.0, 1e9);
}

RangeImage::Bin RangeImage::binOf(const Eigen::Vector3d& direction) {
    int axis = 0;
    const double largest = direction.cwiseAbs().maxCoeff(&axis);
    const auto bin = [&](double v) {
        return std::clamp(static_cast<int>((v / largest + 1) * (kBins / 2.0)), 0,
                          kBins - 1);
    };
    return {2 * axis + (direction[axis] < 0 ? 1 : 0), bin(direction[(axis + 1) % 3]),
            bin(direction[(axis + 2) % 3])};
}

RangeImage::RangeImage(const Mixture<3>& samples, const Eigen::Vector3d& origin)
    : ranges_(std::size_t{6} * kBins * kBins, 0.F) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d ray =
            Eigen::Vector3d(samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]) -
            origin;
        const Bin bin = binOf(ray);
        float& nearest = ranges_[static_cast<std::size_t>(
            (bin.face * kBins + bin.row) * kBins + bin.col)];
        const auto range = static_cast<float>(ray.norm());
        if (nearest == 0.F || range < nearest) nearest = range;
    }
}

float RangeImage::nearestRange(const Eigen::Vector3d& direction) const {
    const Bin bin = binOf(direction);
    float nearest = at(bin.face, bin.row, bin.col);
    if (nearest == 0.F) return 0.F;
    for (int row = std::max(bin.row - 1, 0); row <= std::min(bin.row + 1, kBins - 1); ++row)
        for (int col = std::max(bin.col - 1, 0); col <= std::min(bin.col + 1, kBins - 1);
             ++col) {
            const float range = at(bin.face, row, col);
            if (range > 0.F) nearest = std::min(nearest, range);
        }
    return nearest;
}

bool isSeenThrough(const Gaussian<3>& component, const RangeImage& image,
                   const Eigen::Vector3d& origin) {
    const Eigen::Vector3d ray = component.mean - origin;
    const double range = ray.norm();
    if (!(range > 0)) return false;
    const Eigen::Vector3d u = ray / range;
    const Eigen::Matrix3d covariance = component.covariance;
    const double margin = 3 * std::sqrt(u.dot(covariance * u));
    const auto passes = [&](const Eigen::Vector3d& point) {
        const Eigen::Vector3d towards = point - origin;
        return image.nearestRange(towards) > towards.norm() + margin;
    };
    if (!passes(component.mean)) return false;
    // Points whose moments are the component's: mean +- sqrt(3) columns of the factor.
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    int passed = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.7320508, 1.7320508})
            passed += passes(component.mean + side * L.col(axis)) ? 1 : 0;
    return passed >= 4;
}

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

void CoarseGrid::removeSwap(std::uint32_t i) {
    leave(i);
    const auto last = static_cast<std::uint32_t>(cellOf_.size() - 1);
    if (i != last) {
        auto& members = members_[cellOf_[last]];
        *std::find(members.begin(), members.end(), last) = i;
        cellOf_[i] = cellOf_[last];
    }
    cellOf_.pop_back();
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
