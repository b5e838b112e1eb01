#include "index/surface_pyramid.h"

namespace hgmm {

namespace {

/// The cell two octaves up that holds a block of 4 x 4 x 4 cells.
LatticeCell cellOfBlock(const LatticeCell& block) {
    return {block.octave + CellBlocks::kShift, block.x, block.y, block.z};
}

}  // namespace

void SurfacePyramid::add(const Eigen::Vector3f& mean) {
    LatticeCell cell = smallestCell(mean);
    if (holds(cell)) {
        ++*more_.tryEmplace(cell, 0U).first;
        return;
    }
    while (cell.octave <= kMaxOctave) {
        const LatticeCell block = CellBlocks::blockOf(cell);
        // Larger cells hold another mean.
        if (!cells_.mark(block, CellBlocks::bitOf(cell))) return;
        cell = cellOfBlock(block);
    }
}

void SurfacePyramid::remove(const Eigen::Vector3f& mean) {
    LatticeCell cell = smallestCell(mean);
    if (more_.find(cell) != nullptr) {
        if (--*more_.tryEmplace(cell, 0U).first == 0) more_.erase(cell);
        return;
    }
    while (cell.octave <= kMaxOctave) {
        const LatticeCell block = CellBlocks::blockOf(cell);
        cells_.unmark(block, CellBlocks::bitOf(cell));
        if (cells_.word(block) != 0) return;
        cell = cellOfBlock(block);
    }
}

bool SurfacePyramid::holds(const LatticeCell& cell) const {
    if ((cell.octave - minOctave_) % CellBlocks::kShift == 0)
        return (cells_.word(CellBlocks::blockOf(cell)) & CellBlocks::bitOf(cell)) != 0;
    // Its eight children, which lie in one block.
    constexpr CellBlocks::Word kEight = 0x0000000000330033;
    const LatticeCell lowest{cell.octave - 1, 2 * cell.x, 2 * cell.y, 2 * cell.z};
    return (cells_.word(CellBlocks::blockOf(lowest)) &
            kEight * CellBlocks::bitOf(lowest)) != 0;
}

bool SurfacePyramid::isNearSurface(const LatticeCell& cell) const {
    if (cell.octave > kMaxOctave) return true;
    LatticeCell around = cell;
    while (around.octave < minOctave_) around = around.parent();
    if (holds(around)) return true;
    for (std::int32_t* axis : {&around.x, &around.y, &around.z})
        for (const std::int32_t step : {-1, 2, -1}) {
            *axis += step;
            // The third step only returns to the middle, which was looked at.
            if (holds(around)) return true;
        }
    return false;
}

}  // namespace hgmm
