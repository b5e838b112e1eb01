#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/lattice_table.h"
#include "base/run_pool.h"

namespace hgmm {

/// Component means in a coarse grid: who lies within a box. Means are not kept: the owner
/// passes former ones.
class CoarseGrid {
 public:
    void add(std::uint32_t i, const Eigen::Vector3f& mean);
    /// @param mean with which component i was added
    void remove(std::uint32_t i, const Eigen::Vector3f& mean);
    void move(std::uint32_t i, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
        if (cellOf(from) == cellOf(to)) return;
        remove(i, from);
        add(i, to);
    }
    /// Components in the cells that touch the box, rising.
    std::vector<std::uint32_t> within(const Eigen::Vector3d& low,
                                      const Eigen::Vector3d& high) const;
    std::size_t liveBytes() const { return cells_.liveBytes() + members_.liveBytes(); }

 private:
    static constexpr int kOctave = 3;  // 8 m
    static LatticeCell cellOf(const Eigen::Vector3f& mean) {
        return LatticeCell::at(mean.cast<double>(), kOctave);
    }

    LatticeTable<PoolRun> cells_;
    RunPool<std::uint32_t> members_;
};

}  // namespace hgmm
