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

    /// @param minOctave of the smallest cells, in [kMinOctave, kMaxOctave]: most memory is
    /// theirs
    explicit SurfacePyramid(int minOctave = kMinOctave) : minOctave_(minOctave) {}

    /// Enters or moves component i, which must be < size() or the next one.
    void update(std::uint32_t i, const Eigen::Vector3d& mean);
    /// Drops components n, n + 1, ...
    void truncate(std::size_t n);
    std::size_t size() const { return means_.size(); }
    /// Makes room for n components in all.
    void reserve(std::size_t n);

    /// Whether the cell or one across a face of it holds a surface. Of a cell that is too
    /// small, its parent of minOctave is asked; one that is too large is taken to be near.
    bool isNearSurface(const LatticeCell& cell) const;

    std::size_t liveBytes() const;

 private:
    using Mean = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;

    void count(const LatticeCell& cell, int change);
    bool holds(const LatticeCell& cell) const { return components_.find(cell) != nullptr; }

    /// The smallest cell around a mean; the others are its parents.
    LatticeCell smallestCell(const Mean& mean) const {
        return LatticeCell::at(mean.cast<double>(), minOctave_);
    }

    int minOctave_;
    std::vector<Mean> means_;
    LatticeTable<std::uint32_t> components_;
};

}  // namespace hgmm
