#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "base/dual.h"
#include "hgmm/mixture.h"
#include "occupancy/coverage.h"

namespace hgmm {

/// Where surfaces of the map are open: cells in which the rays of two scans went through a
/// surface and none ended since, as in a door that opened. A component stands for all that
/// was ever hit of a surface; in openings its hits do not count.
class Openings {
 public:
    Openings() = default;
    /// @param once cells that a scan passed; those that are open need not be among them
    Openings(Coverage cells, Coverage once);

    /// Octave of its cells at a distance w from the sensor [m]: finer than coverage's, for
    /// an opening ends where a wall begins.
    static int octaveAt(double w_m, const Coverage::Rays& rays) {
        return rays.octaveAt(w_m) - 1;
    }

    /// @param passed cells in which rays of a scan went through surfaces. Where its rays
    /// also end there is an edge: cells stay as they were.
    /// @param hits where its rays end, in the frame of the surfaces
    void learn(const Coverage& passed, const Mixture<3>& hits,
               const Eigen::Vector3d& sensorOrigin, const Coverage::Rays& rays);
    /// The cells of which keep(cell) holds.
    template <typename Keep>
    Openings where(Keep&& keep) const {
        return {cells_.where(keep), once_.where(keep)};
    }
    void merge(const Openings& other, const Pose& T_local_other) {
        cells_.merge(other.cells_, T_local_other);
        once_.merge(other.once_, T_local_other);
    }

    /// 1 in openings, 0 from half a cell beside them, continuous. T is double or Dual.
    template <typename T>
    T at(const T* x) const {
        return cells_.empty() ? T(0.0) : ofShare(cells_.shareAt(x));
    }
    /// The same by the share of open cells (Coverage::shareAt).
    template <typename T>
    static T ofShare(const T& share) {
        const T twice = 2.0 * share;
        return valueOf(twice) < 1.0 ? twice : T(1.0);
    }

    const Coverage& cells() const { return cells_; }
    const Coverage& once() const { return once_; }
    bool empty() const { return once_.empty(); }
    std::size_t liveBytes() const { return cells_.liveBytes() + once_.liveBytes(); }
    bool operator==(const Openings& o) const {
        return cells_ == o.cells_ && once_ == o.once_;
    }

 private:
    Coverage cells_;
    Coverage once_;  ///< what one scan passed and none ended in since; open cells, too
};

}  // namespace hgmm
