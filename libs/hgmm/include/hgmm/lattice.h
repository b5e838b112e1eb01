#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hgmm {

/// floor(log2(v)) of a normal positive number. std::ilogb is a call, and a lattice asks for
/// millions.
inline int octaveOf(double v) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof(bits));
    return static_cast<int>(bits >> 52U) - 1023;
}

/// 2^exponent, for exponents of normal numbers.
inline double powerOfTwo(int exponent) {
    const auto bits = static_cast<std::uint64_t>(exponent + 1023) << 52U;
    double v = 0;
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

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
    /// The cell of twice the size that holds this one.
    LatticeCell parent() const { return {octave + 1, x >> 1, y >> 1, z >> 1}; }
    bool operator==(const LatticeCell& o) const {
        return octave == o.octave && x == o.x && y == o.y && z == o.z;
    }

 private:
    /// std::floor is a call on processors that cannot be taken for granted. Beyond the
    /// limit any cell will do: nothing is mapped there.
    static std::int32_t floorOf(double v) {
        constexpr double limit = 1e9;
        if (!(v > -limit && v < limit)) return v > 0 ? 1000000000 : -1000000000;
        const auto towardsZero = static_cast<std::int32_t>(v);
        return towardsZero - (v < static_cast<double>(towardsZero) ? 1 : 0);
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
