#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace hgmm {

/// A cell of the lattice of cubes with edges of 2^octave metres.
struct LatticeCell {
    int octave = 0;
    std::int32_t x = 0, y = 0, z = 0;

    /// The cell that holds a point.
    static LatticeCell at(const Eigen::Vector3d& p, int octave);
    bool operator==(const LatticeCell& o) const {
        return octave == o.octave && x == o.x && y == o.y && z == o.z;
    }
};

struct LatticeCellHash {
    std::size_t operator()(const LatticeCell& c) const {
        auto h = static_cast<std::uint64_t>(c.octave + 64);
        for (const std::int32_t v : {c.x, c.y, c.z})
            h = (h ^ static_cast<std::uint32_t>(v)) * 0x9E3779B97F4A7C15ULL, h ^= h >> 29U;
        return static_cast<std::size_t>(h);
    }
};

/// How far the nearest surfaces are, to an octave: the lattice cells of every size that
/// hold the mean of a surface component.
class Clearance {
 public:
    static constexpr int kMinOctave = -4, kMaxOctave = 8;

    /// Enters or moves component i, which must be < size() or the next one.
    void update(std::uint32_t i, const Eigen::Vector3d& mean);
    /// Follows Mixture::removeSwap(i).
    void removeSwap(std::uint32_t i);
    std::size_t size() const { return means_.size(); }

    /// Whether the cell or one across a face of it holds a surface. Octaves are clamped to
    /// the ones kept.
    bool isNearSurface(const LatticeCell& cell) const;

    std::size_t liveBytes() const;

 private:
    using Mean = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;

    void count(const LatticeCell& cell, int change);

    std::vector<Mean> means_;
    std::unordered_map<LatticeCell, std::uint32_t, LatticeCellHash> components_;
};

}  // namespace hgmm
