#include "hgmm/clearance.h"

#include <algorithm>

namespace hgmm {

void Clearance::count(const LatticeCell& cell, int change) {
    const auto entry = components_.try_emplace(cell, 0U).first;
    entry->second += static_cast<std::uint32_t>(change);
    if (entry->second == 0) components_.erase(entry);
}

void Clearance::update(std::uint32_t i, const Eigen::Vector3d& mean) {
    const bool isNew = i == means_.size();
    if (isNew) means_.emplace_back();
    const Eigen::Vector3d before = means_.at(i).cast<double>();
    means_[i] = mean.cast<float>();
    for (int octave = kMinOctave; octave <= kMaxOctave; ++octave) {
        const LatticeCell now = LatticeCell::at(means_[i].cast<double>(), octave);
        if (!isNew) {
            const LatticeCell old = LatticeCell::at(before, octave);
            // Larger cells are the same, too.
            if (old == now) return;
            count(old, -1);
        }
        count(now, 1);
    }
}

void Clearance::removeSwap(std::uint32_t i) {
    const Eigen::Vector3d mean = means_.at(i).cast<double>();
    for (int octave = kMinOctave; octave <= kMaxOctave; ++octave)
        count(LatticeCell::at(mean, octave), -1);
    means_[i] = means_.back();
    means_.pop_back();
}

bool Clearance::isNearSurface(const LatticeCell& cell) const {
    LatticeCell around = cell;
    around.octave = std::clamp(cell.octave, kMinOctave, kMaxOctave);
    if (components_.count(around) > 0) return true;
    for (std::int32_t* axis : {&around.x, &around.y, &around.z})
        for (const std::int32_t step : {-1, 2, -1}) {
            *axis += step;
            // The third step only returns to the middle, which was looked at.
            if (components_.count(around) > 0) return true;
        }
    return false;
}

std::size_t Clearance::liveBytes() const {
    constexpr std::size_t node =
        sizeof(LatticeCell) + sizeof(std::uint32_t) + 3 * sizeof(void*);
    return means_.capacity() * sizeof(Mean) + components_.size() * node +
           components_.bucket_count() * sizeof(void*);
}

}  // namespace hgmm
