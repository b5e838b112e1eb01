#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/lattice_table.h"

namespace hgmm {

/// How far the nearest surfaces are, to an octave: the lattice cells of every size that
/// hold the mean of a surface component.
class SurfacePyramid {
 public:
    static constexpr int kMinOctave = -4, kMaxOctave = 8;

    /// Enters or moves component i, which must be < size() or the next one.
    void update(std::uint32_t i, const Eigen::Vector3d& mean);
    /// Drops components n, n + 1, ...
    void truncate(std::size_t n);
    std::size_t size() const { return means_.size(); }
    /// Makes room for n components in all.
    void reserve(std::size_t n);

    /// Whether the cell or one across a face of it holds a surface. Octaves are clamped to
    /// the ones kept.
    bool isNearSurface(const LatticeCell& cell) const;

    std::size_t liveBytes() const;

 private:
    using Mean = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;

    void count(const LatticeCell& cell, int change);
    bool holds(const LatticeCell& cell) const { return components_.find(cell) != nullptr; }

    std::vector<Mean> means_;
    LatticeTable<std::uint32_t> components_;
};

}  // namespace hgmm
