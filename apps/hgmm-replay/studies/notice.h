#pragma once
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "studies/dynamics_world.h"

namespace replay {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kNotTaken = std::numeric_limits<double>::quiet_NaN();

constexpr int kPatience = 100;  ///< scans that a change may take to be noticed

using Say = bool (*)(const hgmm::Occupancy&);

/// How soon the maps of a world say of points what is so.
class Notice {
 public:
    Notice(const World& world, hgmm::evaluation::Points points_map, Say isRight)
        : world_(world), points_map_(std::move(points_map)), isRight_(isRight) {
        shares_.resize(world.maps().size());
    }

    /// After each scan since the change.
    void look() {
        for (std::size_t m = 0; m < shares_.size(); ++m)
            shares_[m].push_back(hgmm::evaluation::shareOf(
                world_.maps()[m]->occupancy(points_map_), isRight_));
    }
    /// Scans until at least this share was right.
    double scansUntil(double share, std::size_t map) const {
        for (std::size_t i = 0; i < shares_[map].size(); ++i)
            if (shares_[map][i] >= share) return static_cast<double>(i + 1);
        return points_map_.empty() ? kNotTaken : kNever;
    }
    bool allNoticed(double share) const {
        for (std::size_t m = 0; m < shares_.size(); ++m)
            if (!std::isfinite(scansUntil(share, m))) return points_map_.empty();
        return true;
    }
    double first(std::size_t map) const { return shares_[map].front(); }
    double last(std::size_t map) const { return shares_[map].back(); }
    double points() const { return static_cast<double>(points_map_.size()); }

 private:
    const World& world_;
    hgmm::evaluation::Points points_map_;
    Say isRight_;
    std::vector<std::vector<double>> shares_;  ///< of each map after each scan
};

}  // namespace replay
