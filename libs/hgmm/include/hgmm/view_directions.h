#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// From where a surface component was seen.
struct ViewDirection {
    /// Unit vector from the surface towards the sensors, support-weighted mean; zero where
    /// it is not known (maps saved before there were views).
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double range_m = 0.0;  ///< mean distance of the sensors [m], >= 0

    bool known() const { return !direction.isZero(); }
};

/// The view of two components together, each counting by its support.
HGMM_EXPORT ViewDirection merged(const ViewDirection& a, double supportA,
                                 const ViewDirection& b, double supportB);

/// How `sensorOrigin` sees the point `mean`, both in one frame.
HGMM_EXPORT ViewDirection viewFrom(const Eigen::Vector3d& sensorOrigin,
                                   const Eigen::Vector3d& mean);

/// The views of a mixture's components, in its order.
class HGMM_EXPORT ViewDirections {
 public:
    std::size_t size() const { return range_.size(); }
    /// Makes room for n views in all.
    void reserve(std::size_t n);
    void pushBack(const ViewDirection& view);
    /// Overwrites view i < size().
    void set(std::size_t i, const ViewDirection& view);
    /// Follows Mixture::removeSwap(i).
    void removeSwap(std::size_t i);
    /// i < size().
    ViewDirection operator[](std::size_t i) const {
        return {{direction_[0][i], direction_[1][i], direction_[2][i]}, range_[i]};
    }
    bool operator==(const ViewDirections& o) const {
        return direction_ == o.direction_ && range_ == o.range_;
    }

    /// Calls visit(array) for each array of floats: for saving.
    template <typename Visitor>
    void forEachArray(Visitor&& visit) {
        for (auto& axis : direction_) visit(axis);
        visit(range_);
    }
    template <typename Visitor>
    void forEachArray(Visitor&& visit) const {
        for (const auto& axis : direction_) visit(axis);
        visit(range_);
    }

 private:
    std::array<std::vector<float>, 3> direction_;
    std::vector<float> range_;
};

}  // namespace hgmm
