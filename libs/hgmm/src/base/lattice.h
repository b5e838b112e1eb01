#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "base/power_of_two.h"

namespace hgmm {

/// A cell of the lattice of cubes with edges of 2^octave metres.
struct LatticeCell {
    int octave = 0;
    std::int32_t x = 0, y = 0, z = 0;

    /// The cell that holds a point.
    static LatticeCell at(const Eigen::Vector3d& p, int octave) {
        const double perCell = powerOfTwo(-octave);
        return {octave, floorOf(p.x() * perCell), floorOf(p.y() * perCell),
                floorOf(p.z() * perCell)};
    }
    Eigen::Vector3d centre() const {
        return (Eigen::Vector3d(x, y, z).array() + 0.5) * powerOfTwo(octave);
    }
    /// The cell of twice the size that holds this one.
    LatticeCell parent() const { return {octave + 1, x >> 1, y >> 1, z >> 1}; }
    bool operator==(const LatticeCell& o) const {
        return octave == o.octave && x == o.x && y == o.y && z == o.z;
    }

 private:
    /// Beyond the limit any cell will do: nothing is mapped there.
    static std::int32_t floorOf(double v) {
        constexpr std::int32_t limit = 1000000000;
        if (!(v > -limit && v < limit)) return v > 0 ? limit : -limit;
        return floorToInt(v);
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

}  // namespace hgmm
