#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/power_of_two.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"
#include "index/cell_blocks.h"

namespace hgmm {

/// Where rays passed: one bit for each cell of lattices whose edges grow with the distance
/// to the sensor, as the spacing of its rays does. Mixtures say how likely a point is
/// occupied or free; their tails cannot say whether any ray was there.
///
/// Cells are kept in blocks of 4 x 4 x 4, one word each.
class Coverage {
 public:
    /// The cells of one block; bit x + 4 y + 16 z is the cell (x, y, z) in it.
    using Word = CellBlocks::Word;
    static constexpr int kBlockShift = CellBlocks::kShift;

    /// Where rays mark the cells of a lattice.
    struct Stretch {
        int octave;
        double from_m, to_m;  ///< distances from the sensor
        /// Lattices overlap by a cell: where one ends, the other is whole.
        double start_m() const { return std::max(0.0, from_m - powerOfTwo(octave)); }
    };

    /// What the rays of one scan have in common.
    class Rays {
     public:
        /// @param raySpacing_rad angle between neighbouring rays
        /// @param normalOfRays unit normal of the plane of all rays, in the local frame;
        /// zero where there is none
        Rays(const CoverageParams& params, double raySpacing_rad,
             const Eigen::Vector3d& normalOfRays);
        const Eigen::Vector3d& normal() const { return normal_; }
        double spacing_rad() const { return spacing_rad_; }
        /// Octave of the cells at a distance w from the sensor [m].
        int octaveAt(double w_m) const;
        /// Distance at which the cells of an octave end [m].
        double endOf(int octave) const;
        /// How much of a ray before a hit marks nothing [m]: half a cell.
        double leftOut(double range_m) const;
        /// Calls visit(stretch) for each lattice of which a ray of a length marks cells.
        template <typename Visitor>
        void forEachStretch(double length_m, Visitor&& visit) const {
            double from_m = 0.0;
            for (int octave = octaveAt(0.0); from_m < length_m; ++octave) {
                const Stretch stretch{octave, from_m, endOf(octave)};
                visit(stretch);
                from_m = stretch.to_m;
            }
        }

     private:
        Eigen::Vector3d normal_;
        double spacing_rad_, atOneMetre_m_, perMetre_;
    };

    /// Marks the cells that a ray passes, in the local frame. The last half cell before
    /// `end` is left out if it `isHit`.
    void markRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& end, bool isHit,
                 const Rays& rays);

    /// C(x) in [0, 1]: the trilinear share of marked cells, squared, largest over the
    /// lattices. Around a ray of its own, without its neighbours, it ends sooner so.
    /// Continuous; 0 where no ray was near. T is double or Dual.
    template <typename T>
    T at(const T* x) const {
        const T share = shareAt(x);
        return share * share;
    }
    /// The trilinear share of marked cells in [0, 1], largest over the lattices.
    template <typename T>
    T shareAt(const T* x) const;
    /// at() for points that follow each other closely (occupancy/coverage_reader.h).
    class Reader;

    /// Adds the cells of another map, whose frame has pose T_local_other here. A cell is
    /// marked if its centre lies in a marked one of the other.
    void merge(const Coverage& other, const Pose& T_local_other);

    /// The cells of which keep(cell) holds.
    template <typename Keep>
    Coverage where(Keep&& keep) const {
        Coverage kept;
        forEachBlock([&](const LatticeCell& block, Word word) {
            forEachCell(block, word, [&](const LatticeCell& cell) {
                if (keep(cell)) kept.mark(cell);
            });
        });
        return kept;
    }

    /// Marks, in another one, the marked cells that at() looks at for points of a box.
    void copyAround(const Eigen::AlignedBox3d& box, Coverage& part) const;

    /// Without the cells in which a coarser lattice says C = 1: they say nothing new.
    Coverage pruned() const;
    /// On lattices of twice the edge, `times` times over. A cell of which at least half is
    /// marked stays marked.
    Coverage coarsened(int times) const;

    /// Octaves of the lattices that hold cells, rising: their edges are 2^octave m.
    const std::vector<int>& octaves() const { return octaves_; }
    /// Calls visit(block, word) for each block that holds cells, in no order. A block's
    /// coordinates are those of its cells / 4, its octave is theirs.
    template <typename Visitor>
    void forEachBlock(Visitor&& visit) const {
        blocks_.forEach(visit);
    }
    /// The cells of a block; none where there is no such block.
    Word word(const LatticeCell& block) const { return blocks_.word(block); }
    /// The cells of 4 x 4 x 4 blocks, whose coordinates are those of the group times 4 and
    /// more, until the next change.
    CellBlocks::GroupView group(const LatticeCell& group) const {
        return blocks_.group(group);
    }
    /// Marks or unmarks cells of a block.
    void mark(const LatticeCell& block, Word cells);
    void mark(const LatticeCell& cell);
    /// Marks the cells of a lattice that a segment passes.
    void markSegment(int octave, const Eigen::Vector3d& from, const Eigen::Vector3d& to);
    /// The same for a part of a ray.
    void markStretch(int octave, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                     const Rays& rays);
    void unmark(const LatticeCell& block, Word cells);

    std::size_t blockCount() const { return blocks_.size(); }
    std::size_t liveBytes() const { return blocks_.liveBytes(); }
    bool operator==(const Coverage& o) const;
    bool empty() const { return octaves_.empty(); }

 private:
    /// A lattice holds cells.
    void note(int octave);
    /// The group of blocks that was looked at last.
    struct LastGroup {
        LatticeCell cell = LatticeCellKeys::unused();
        std::optional<CellBlocks::GroupView> blocks;
    };
    Word word(const LatticeCell& block, LastGroup& last) const {
        const LatticeCell group = CellBlocks::blockOf(block);
        if (!(group == last.cell)) {
            last.cell = group;
            last.blocks.emplace(blocks_.group(group));
        }
        return last.blocks->word(CellBlocks::placeOf(block));
    }
    /// The trilinear share of marked cells of one lattice; exactly 1 if all are.
    template <typename T>
    T shareAt(const T* x, int octave, LastGroup& last) const;
    /// Which of the eight cells whose lowest is `low` are marked: bit dx + 2 dy + 4 dz.
    unsigned corners(const LatticeCell& low, LastGroup& last) const;
    /// The cells of a word of a block in which no coarser lattice says C = 1.
    Word withoutCovered(const LatticeCell& block, Word word) const;

    CellBlocks blocks_;
    std::vector<int> octaves_;
};

}  // namespace hgmm
