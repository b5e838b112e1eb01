#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hgmm/gaussian.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// Finds the components near a point at a cost that does not depend on the size of the map,
/// and keeps them factored for evaluation.
///
/// A hash grid with one level per octave of component size: a component is entered in every
/// cell, of a size just above its own, that the bounding box of its `sigmas` ellipsoid
/// touches; a query looks up one cell per level in use.
class ComponentIndex {
 public:
    using Factor = WhitenedGaussian<3, float>;

    /// @param sigmas size of the indexed ellipsoids [sigma], > 0
    /// @param inflationStd_m isotropic standard deviation added to every component [m], >=
    /// 0
    explicit ComponentIndex(float sigmas = kSigmas, float inflationStd_m = 0.F)
        : sigmas_(sigmas), inflationVariance_(inflationStd_m * inflationStd_m) {}

    static constexpr float kSigmas = 4.F;

    /// Enters every component of a mixture, which must outlive no call: data is copied.
    void rebuild(const Mixture<3>& mixture);
    /// Enters or re-enters component i, which must be < size() or the next one.
    void update(const Mixture<3>& mixture, std::uint32_t i);
    /// Follows Mixture::removeSwap(i).
    void removeSwap(std::uint32_t i);
    void clear();

    std::size_t size() const { return factors_.size(); }
    const Factor& factor(std::uint32_t i) const { return factors_[i]; }

    /// Calls visit(i) for each component whose ellipsoid's box may hold (x, y, z), each
    /// once, in a fixed order.
    template <typename Visitor>
    void visitCandidates(float x, float y, float z, Visitor&& visit) const;

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    struct Placement {
        std::int8_t octave = 0;
        std::array<std::int32_t, 3> low{}, high{};
        bool operator==(const Placement& o) const {
            return octave == o.octave && low == o.low && high == o.high;
        }
    };
    static constexpr int kMinOctave = -10, kMaxOctave = 20;
    using Cells = std::unordered_map<std::uint64_t, std::vector<std::uint32_t>>;

    static std::uint64_t key(std::int32_t x, std::int32_t y, std::int32_t z) {
        constexpr std::uint64_t mask = (1U << 21U) - 1U;
        return (std::uint64_t(x) & mask) << 42U | (std::uint64_t(y) & mask) << 21U |
               (std::uint64_t(z) & mask);
    }
    static std::int32_t cellOf(float v, int octave);
    Placement placementOf(const Gaussian<3>& g) const;
    void enter(std::uint32_t i);
    void leave(std::uint32_t i);

    float sigmas_;
    float inflationVariance_;
    std::vector<Factor> factors_;
    std::vector<Placement> placements_;
    std::array<Cells, kMaxOctave - kMinOctave + 1> levels_;
};

template <typename Visitor>
void ComponentIndex::visitCandidates(float x, float y, float z, Visitor&& visit) const {
    for (int level = 0; level <= kMaxOctave - kMinOctave; ++level) {
        const Cells& cells = levels_[level];
        if (cells.empty()) continue;
        const int octave = level + kMinOctave;
        const auto cell =
            cells.find(key(cellOf(x, octave), cellOf(y, octave), cellOf(z, octave)));
        if (cell == cells.end()) continue;
        for (const std::uint32_t i : cell->second) visit(i);
    }
}

}  // namespace hgmm
