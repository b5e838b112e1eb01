#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/lattice.h"

namespace hgmm {

/// Component means in a coarse grid: who lies within a box.
class CoarseGrid {
 public:
    /// Enters or moves component i, which must be < size() or the next one.
    void update(std::uint32_t i, const Eigen::Vector3d& mean);
    /// Drops components n, n + 1, ...
    void truncate(std::size_t n);
    /// Components in the cells that touch the box, rising.
    std::vector<std::uint32_t> within(const Eigen::Vector3d& low,
                                      const Eigen::Vector3d& high) const;
    std::size_t size() const { return cellOf_.size(); }
    std::size_t liveBytes() const;

 private:
    static constexpr int kOctave = 3;  // 8 m
    void leave(std::uint32_t i);

    std::vector<LatticeCell> cellOf_;
    std::unordered_map<LatticeCell, std::vector<std::uint32_t>, LatticeCellHash> members_;
};

}  // namespace hgmm
