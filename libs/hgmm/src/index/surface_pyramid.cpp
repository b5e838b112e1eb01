#include "index/surface_pyramid.h"

namespace hgmm {

void SurfacePyramid::count(const LatticeCell& cell, int change) {
    std::uint32_t& components = *components_.tryEmplace(cell, 0U).first;
    components += static_cast<std::uint32_t>(change);
    if (components == 0) components_.erase(cell);
}

void SurfacePyramid::reserve(std::size_t n) {
    means_.reserve(n);
    components_.reserve(n);
}

void SurfacePyramid::update(std::uint32_t i, const Eigen::Vector3d& mean) {
    const bool isNew = i == means_.size();
    if (isNew) means_.emplace_back();
    LatticeCell old = smallestCell(means_.at(i));
    means_[i] = mean.cast<float>();
    LatticeCell now = smallestCell(means_[i]);
    for (; now.octave <= kMaxOctave; now = now.parent(), old = old.parent()) {
        if (!isNew) {
            // Larger cells are the same, too.
            if (old == now) return;
            count(old, -1);
        }
        count(now, 1);
    }
}

void SurfacePyramid::truncate(std::size_t n) {
    for (; means_.size() > n; means_.pop_back())
        for (LatticeCell cell = smallestCell(means_.back()); cell.octave <= kMaxOctave;
             cell = cell.parent())
            count(cell, -1);
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

std::size_t SurfacePyramid::liveBytes() const {
    return means_.capacity() * sizeof(Mean) + components_.liveBytes();
}

}  // namespace hgmm
