#include "hgmm/filter.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "hgmm/require.h"

namespace hgmm {

namespace {

/// Sums over the points of one leaf, taken about its first point so that they keep their
/// digits far from the sensor.
struct Leaf {
    std::uint64_t key = 0;
    std::array<float, 3> anchor{};
    double count = 0;
    std::array<double, 3> sum{};
    std::array<double, 6> sumOuter{};

    void add(float x, float y, float z) {
        const double dx = double(x) - anchor[0], dy = double(y) - anchor[1],
                     dz = double(z) - anchor[2];
        count += 1;
        sum[0] += dx, sum[1] += dy, sum[2] += dz;
        sumOuter[0] += dx * dx, sumOuter[1] += dx * dy, sumOuter[2] += dx * dz;
        sumOuter[3] += dy * dy, sumOuter[4] += dy * dz, sumOuter[5] += dz * dz;
    }
};

/// Open-addressing table from leaf key to leaf, in order of first appearance.
class LeafTable {
 public:
    explicit LeafTable(std::size_t points) {
        std::size_t slots = 1024;
        while (slots < points / 8) slots *= 2;
        slots_.assign(slots, kFree);
    }

    Leaf& find(std::uint64_t key, float x, float y, float z) {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t slot = hash(key) & mask;; slot = (slot + 1) & mask) {
            if (slots_[slot] == kFree) {
                if (2 * (leaves_.size() + 1) > slots_.size()) {
                    grow();
                    return find(key, x, y, z);
                }
                slots_[slot] = static_cast<std::uint32_t>(leaves_.size());
                leaves_.push_back({key, {x, y, z}, 0, {}, {}});
            }
            Leaf& leaf = leaves_[slots_[slot]];
            if (leaf.key == key) return leaf;
        }
    }

    const std::vector<Leaf>& leaves() const { return leaves_; }

 private:
    static constexpr std::uint32_t kFree = 0xFFFFFFFFU;

    static std::size_t hash(std::uint64_t key) {
        key *= 0x9E3779B97F4A7C15ULL;
        return static_cast<std::size_t>(key ^ (key >> 32U));
    }

    void grow() {
        slots_.assign(slots_.size() * 4, kFree);
        const std::size_t mask = slots_.size() - 1;
        for (std::uint32_t i = 0; i < leaves_.size(); ++i) {
            std::size_t slot = hash(leaves_[i].key) & mask;
            while (slots_[slot] != kFree) slot = (slot + 1) & mask;
            slots_[slot] = i;
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Leaf> leaves_;
};

std::uint64_t leafKey(int octave, float x, float y, float z) {
    // 19 bits an axis hold any leaf index, at the smallest leaves and 100 km.
    constexpr std::uint64_t mask = (1U << 19U) - 1U;
    const float perLeaf = std::ldexp(1.F, -octave);
    const auto cell = [&](float v) {
        return static_cast<std::uint64_t>(
                   static_cast<std::int64_t>(std::floor(v * perLeaf))) &
               mask;
    };
    return static_cast<std::uint64_t>(octave + 32) << 57U | cell(x) << 38U |
           cell(y) << 19U | cell(z);
}

Gaussian<3> sampleOf(const Leaf& leaf, const FilterParams& params) {
    Gaussian<3> g;
    g.support = leaf.count;
    Eigen::Vector3d offset(leaf.sum[0], leaf.sum[1], leaf.sum[2]);
    offset /= leaf.count;
    for (int row = 0, k = 0; row < 3; ++row)
        for (int col = row; col < 3; ++col, ++k)
            g.covariance(row, col) = g.covariance(col, row) =
                leaf.sumOuter[k] / leaf.count - offset[row] * offset[col];
    for (int d = 0; d < 3; ++d) g.mean[d] = leaf.anchor[d] + offset[d];
    const double noise = params.noiseAt(g.mean.norm());
    for (int d = 0; d < 3; ++d)
        g.covariance(d, d) = std::max(g.covariance(d, d), 0.0) + noise * noise;
    return g;
}

}  // namespace

void FilterParams::validate() const {
    requireInRange("leafAtOneMetre_m", leafAtOneMetre_m, 5e-3, 10.0);
    requireInRange("minLeaf_m", minLeaf_m, 1e-4, 100.0);
    requireInRange("minRange_m", minRange_m, 0.0, 1e5);
    requireInRange("maxRange_m", maxRange_m, minRange_m, 1e5);
    requireInRange("noiseStd_m", noiseStd_m, 1e-4, 10.0);
    requireInRange("noisePerRange", noisePerRange, 0.0, 0.1);
}

Mixture<3> filterScan(const Scan& scan, const FilterParams& params, FilterCounts* counts) {
    const auto leafAtOneMetre = static_cast<float>(params.leafAtOneMetre_m);
    const auto minLeaf = static_cast<float>(params.minLeaf_m);
    const auto minRange = static_cast<float>(params.minRange_m);
    const auto maxRange = static_cast<float>(params.maxRange_m);
    FilterCounts counted;
    LeafTable table(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const float x = scan.x[i], y = scan.y[i], z = scan.z[i];
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
            ++counted.notFinite;
            continue;
        }
        const float range = std::sqrt(x * x + y * y + z * z);
        if (!(range >= minRange && range <= maxRange) || range == 0.F) {
            ++counted.outOfRange;
            continue;
        }
        const int octave = std::ilogb(std::max(minLeaf, leafAtOneMetre * std::sqrt(range)));
        table.find(leafKey(octave, x, y, z), x, y, z).add(x, y, z);
        ++counted.used;
    }
    Mixture<3> samples;
    samples.reserve(table.leaves().size());
    for (const Leaf& leaf : table.leaves()) samples.pushBack(sampleOf(leaf, params));
    if (counts != nullptr) *counts = counted;
    return samples;
}

Mixture<3> transformed(const Mixture<3>& mixture, const Pose& T_target_source) {
    Mixture<3> result = mixture;
    const Eigen::Matrix3d& R = T_target_source.R;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        Gaussian<3> g = mixture[i];
        g.mean = R * g.mean + T_target_source.t;
        g.covariance = R * g.covariance * R.transpose();
        result.set(i, g);
    }
    return result;
}

}  // namespace hgmm
