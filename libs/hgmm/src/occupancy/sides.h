#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "base/dual.h"

namespace hgmm {

/// On which side of the surfaces around it a point lies. Cells of coverage reach past the
/// surfaces in them, so that rays along a wall cover a layer of its inside; it counts for
/// nothing where a point is behind surfaces, in front of none, and the space farther behind
/// them was never passed or they face away from each other: there is a solid between.
/// Behind a thin plate rays did pass. T is double or Dual.
template <typename T>
class Sides {
 public:
    /// @param side in [0, 1]: 1 well in front of a surface, and not beside it
    void addFront(const T& side) { raise(inFront_, side); }
    /// @param side in [0, 1]: 1 well behind a surface, and not beside it
    /// @param view unit vector from the surface to the sensor
    /// @param coverageBeyond C farther behind the surface
    void addBehind(const T& side, const std::array<float, 3>& view, double coverageBeyond) {
        raise(behind_, side);
        raise(solid_, side * (1.0 - coverageBeyond));
        for (int d = 0; d < 3; ++d) views_[d] += valueOf(side) * double(view[d]);
        weight_ += valueOf(side);
    }

    /// How much of the coverage at the point does not count, in [0, 1].
    T shadow() const {
        if (!(weight_ > 0)) return 0.0;
        const double together = std::sqrt(views_[0] * views_[0] + views_[1] * views_[1] +
                                          views_[2] * views_[2]);
        // Views at a right angle, as those of two sides of a box, make 0.73 of it.
        T most = behind_ * std::min(1.0, 2.5 * std::max(0.0, 1.0 - together / weight_));
        raise(most, solid_);
        return most * (1.0 - inFront_);
    }

 private:
    static void raise(T& most, const T& value) {
        if (valueOf(value) > valueOf(most)) most = value;
    }

    T inFront_ = 0.0, behind_ = 0.0, solid_ = 0.0;
    double views_[3] = {}, weight_ = 0.0;
};

}  // namespace hgmm
