#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "base/lattice_table.h"
#include "index/cell_blocks.h"

namespace hgmm {

/// How far the nearest surfaces are, to an octave: the lattice cells of every size that
/// hold the mean of a surface component.
class SurfacePyramid {
 public:
    static constexpr int kMinOctave = -4, kMaxOctave = 8;

    /// @param minOctave of the smallest cells, in [kMinOctave, kMaxOctave]
    explicit SurfacePyramid(int minOctave = kMinOctave) : minOctave_(minOctave) {}

    /// Means are those of components as they are stored, in single precision.
    void add(const Eigen::Vector3f& mean);
    /// @param mean one that was added
    void remove(const Eigen::Vector3f& mean);
    void move(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
        if (smallestCell(from) == smallestCell(to)) return;
        remove(from);
        add(to);
    }

    /// Whether the cell or one across a face of it holds a surface. Of a cell that is too
    /// small, its parent of minOctave is asked; one that is too large is taken to be near.
    bool isNearSurface(const LatticeCell& cell) const;

    std::size_t liveBytes() const { return cells_.liveBytes() + more_.liveBytes(); }

 private:
    bool holds(const LatticeCell& cell) const;

    /// The smallest cell around a mean; the others are its parents.
    LatticeCell smallestCell(const Eigen::Vector3f& mean) const {
        return LatticeCell::at(mean.cast<double>(), minOctave_);
    }

    int minOctave_;
    /// Of every other octave from minOctave on: those of one are the blocks of the one
    /// before, and the cells between hold what their children do.
    CellBlocks cells_;
    LatticeTable<std::uint32_t> more_;  ///< means beyond the first in smallest cells
};

}  // namespace hgmm
