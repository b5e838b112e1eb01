#include "hgmm/component_index.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hgmm {

std::int32_t ComponentIndex::cellOf(float v, int octave) {
    // Beyond the limit (and for NaN) any cell will do: nothing is indexed there.
    constexpr float limit = 1 << 30;
    const float cell = std::floor(std::ldexp(v, -octave));
    return cell > -limit && cell < limit ? static_cast<std::int32_t>(cell) : 1 << 30;
}

ComponentIndex::Placement ComponentIndex::placementOf(const Gaussian<3>& g) const {
    std::array<double, 3> halfExtent{};
    double largest = 0;
    for (int d = 0; d < 3; ++d) {
        halfExtent[d] = sigmas_ * std::sqrt(g.covariance(d, d));
        largest = std::max(largest, halfExtent[d]);
    }
    Placement p;
    p.octave = static_cast<std::int8_t>(std::clamp(
        static_cast<int>(std::ceil(std::log2(largest))), kMinOctave, kMaxOctave));
    for (int d = 0; d < 3; ++d) {
        p.low[d] = cellOf(static_cast<float>(g.mean[d] - halfExtent[d]), p.octave);
        p.high[d] = cellOf(static_cast<float>(g.mean[d] + halfExtent[d]), p.octave);
    }
    return p;
}

void ComponentIndex::enter(std::uint32_t i) {
    const Placement& p = placements_[i];
    Cells& cells = levels_[p.octave - kMinOctave];
    for (std::int32_t x = p.low[0]; x <= p.high[0]; ++x)
        for (std::int32_t y = p.low[1]; y <= p.high[1]; ++y)
            for (std::int32_t z = p.low[2]; z <= p.high[2]; ++z)
                cells[key(x, y, z)].push_back(i);
}

void ComponentIndex::leave(std::uint32_t i) {
    const Placement& p = placements_[i];
    Cells& cells = levels_[p.octave - kMinOctave];
    for (std::int32_t x = p.low[0]; x <= p.high[0]; ++x)
        for (std::int32_t y = p.low[1]; y <= p.high[1]; ++y)
            for (std::int32_t z = p.low[2]; z <= p.high[2]; ++z) {
                const auto cell = cells.find(key(x, y, z));
                auto& members = cell->second;
                members.erase(std::find(members.begin(), members.end(), i));
                if (members.empty()) cells.erase(cell);
            }
}

void ComponentIndex::update(const Mixture<3>& mixture, std::uint32_t i) {
    Gaussian<3> g = mixture[i];
    for (int d = 0; d < 3; ++d) g.covariance(d, d) += inflationVariance_;
    const Placement placement = placementOf(g);
    if (i > factors_.size())
        throw std::out_of_range("ComponentIndex::update: a gap before it");
    if (i == factors_.size()) {
        factors_.emplace_back(g);
        placements_.push_back(placement);
        enter(i);
        return;
    }
    factors_[i] = Factor(g);
    if (placement == placements_[i]) return;
    leave(i);
    placements_[i] = placement;
    enter(i);
}

void ComponentIndex::removeSwap(std::uint32_t i) {
    const auto last = static_cast<std::uint32_t>(factors_.size() - 1);
    leave(i);
    if (i != last) {
        leave(last);
        factors_[i] = factors_[last];
        placements_[i] = placements_[last];
        enter(i);
    }
    factors_.pop_back();
    placements_.pop_back();
}

void ComponentIndex::rebuild(const Mixture<3>& mixture) {
    clear();
    factors_.reserve(mixture.size());
    placements_.reserve(mixture.size());
    for (std::uint32_t i = 0; i < mixture.size(); ++i) update(mixture, i);
}

void ComponentIndex::clear() {
    factors_.clear();
    placements_.clear();
    for (Cells& cells : levels_) cells.clear();
}

std::size_t ComponentIndex::liveBytes() const {
    // A node of the hash table: key, vector header, next pointer and the allocator's word.
    constexpr std::size_t nodeBytes =
        sizeof(std::uint64_t) + sizeof(std::vector<std::uint32_t>) + 2 * sizeof(void*);
    std::size_t bytes =
        factors_.capacity() * sizeof(Factor) + placements_.capacity() * sizeof(Placement);
    for (const Cells& cells : levels_) {
        bytes += cells.bucket_count() * sizeof(void*) + cells.size() * nodeBytes;
        for (const auto& cell : cells)
            bytes += cell.second.capacity() * sizeof(std::uint32_t);
    }
    return bytes;
}

}  // namespace hgmm
