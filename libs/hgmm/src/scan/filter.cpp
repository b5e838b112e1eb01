#include "hgmm/scan.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/simd.h"
#include "hgmm/params.h"
#include "scan/voxel_table.h"

namespace hgmm {

namespace {

/// Sums over points d = (dx, dy, dz, 1) about an anchor [m].
struct FloatSums {
    Float4 x{}, y{}, z{};  ///< dx d, dy d, dz d
    std::int32_t count = 0;

    void add(Float4 d) {
        x += d[0] * d;
        y += d[1] * d;
        z += d[2] * d;
        ++count;
    }
    /// Adds four points.
    void add(Float4 dx, Float4 dy, Float4 dz) {
        const Float4 xy = dx * dy, xz = dx * dz, yz = dy * dz;
        x += sumsOfLanes(dx * dx, xy, xz, dx);
        y += sumsOfLanes(xy, dy * dy, yz, dy);
        z += sumsOfLanes(xz, yz, dz * dz, dz);
        count += 4;
    }
};

/// The same of any number of points: floats keep their digits over some of them.
struct Sums {
    static constexpr std::int32_t kFloats = 1024;
    FloatSums last;
    std::array<double, 10> former{};  ///< count, dx, dy, dz, dx dx, dx dy, ... dz dz

    std::array<double, 10> total() const {
        const Float4 &x = last.x, &y = last.y, &z = last.z;
        std::array<double, 10> sum{
            double(last.count), x[3], y[3], z[3], x[0], x[1], x[2], y[1], y[2], z[2]};
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += former[k];
        return sum;
    }
    void settle() {
        former = total();
        last = FloatSums();
    }
};

/// The leaves of the points that are in range, in order of first appearance.
class LeafSums {
 public:
    explicit LeafSums(std::size_t points) : table_(points) {}

    void add(const Leaves4& leaves, Float4 x, Float4 y, Float4 z) {
        // Neighbouring points mostly share a leaf: its sums are held until another's turn.
        const unsigned used = bitsOf(leaves.isInRange);
        unsigned mine = bitsOf(leaves.areIn(current_));
        if ((used & mine) == 15U)
            sums_.add(x - anchor_[0], y - anchor_[1], z - anchor_[2]);
        else
            for (unsigned left = used; left != 0; left &= left - 1) {
                const auto k = static_cast<unsigned>(__builtin_ctz(left));
                if ((mine >> k & 1U) == 0) {
                    enter(leaves, k, x[k], y[k], z[k]);
                    mine = bitsOf(leaves.areIn(current_));
                }
                sums_.add(Float4{x[k], y[k], z[k], 1.F} - anchor_);
            }
        if (sums_.count >= Sums::kFloats)
            flush(), leaf_->sums.settle(), sums_ = FloatSums();
    }
    std::size_t leafCount() const { return table_.leaves().size(); }
    const std::vector<Leaf<Sums>>& leaves() {
        flush();
        return table_.leaves();
    }

 private:
    void enter(const Leaves4& leaves, unsigned k, float x, float y, float z) {
        flush();
        current_ = leaves.lane(k);
        leaf_ = &table_.find(leaves.key(k), x, y, z);
        anchor_ = Float4{leaf_->anchor[0], leaf_->anchor[1], leaf_->anchor[2], 0.F};
        sums_ = leaf_->sums.last;
    }
    void flush() {
        if (leaf_ != nullptr) leaf_->sums.last = sums_;
    }

    VoxelTable<Sums> table_;
    Leaves4 current_{{}, Int4{} - 1000, {}, {}, {}};  ///< no leaf has this octave
    Leaf<Sums>* leaf_ = nullptr;                      ///< of the current points
    Float4 anchor_{};
    FloatSums sums_;
};

Gaussian<3> sampleOf(const Leaf<Sums>& leaf, const FilterParams& params) {
    const std::array<double, 10> v = leaf.sums.total();
    Gaussian<3> g;
    g.support = v[0];
    const Eigen::Vector3d offset(v[1] / v[0], v[2] / v[0], v[3] / v[0]);
    for (int row = 0, k = 4; row < 3; ++row)
        for (int col = row; col < 3; ++col, ++k)
            g.covariance(row, col) = g.covariance(col, row) =
                v[k] / v[0] - offset[row] * offset[col];
    for (int d = 0; d < 3; ++d) g.mean[d] = leaf.anchor[d] + offset[d];
    const double noise = params.noiseAt(g.mean.norm());
    for (int d = 0; d < 3; ++d)
        g.covariance(d, d) = std::max(g.covariance(d, d), 0.0) + noise * noise;
    return g;
}

/// Adds all points, unless they fill more leaves than there may be samples. Returns whether
/// it did.
bool addPoints(const Scan& scan, const LeafKeys& keysOf, LeafSums& sums,
               FilterCounts& counted) {
    for (std::size_t i = 0; i < scan.size(); i += 4) {
        const std::size_t count = std::min<std::size_t>(4, scan.size() - i);
        const Float4 x = loadUpTo4(&scan.x[i], count), y = loadUpTo4(&scan.y[i], count),
                     z = loadUpTo4(&scan.z[i], count);
        const Leaves4 leaves = keysOf.leavesOf(x, y, z);
        const unsigned used = bitsOf(leaves.isInRange);
        if (used == 15U) {
            counted.used += 4;
        } else {
            for (std::size_t k = 0; k < count; ++k)
                if ((used >> k & 1U) != 0)
                    ++counted.used;
                else
                    countDropped({x[k], y[k], z[k]}, keysOf.maxRange2(), counted);
        }
        sums.add(leaves, x, y, z);
        if (sums.leafCount() > kMaxSamples) return false;
    }
    return true;
}

Mixture<3> samplesOf(const std::vector<Leaf<Sums>>& leaves, const FilterParams& params) {
    Mixture<3> samples;
    samples.reserve(leaves.size());
    for (const Leaf<Sums>& filled : leaves) samples.pushBack(sampleOf(filled, params));
    return samples;
}

}  // namespace

Mixture<3> filterScan(const Scan& scan, const FilterParams& params, FilterCounts* counts) {
    FilterParams leaves = params;
    for (int doublings = 0;; ++doublings, leaves = doubled(leaves)) {
        FilterCounts counted;
        counted.doublings = doublings;
        LeafSums sums(scan.size());
        if (!addPoints(scan, LeafKeys(leaves), sums, counted)) continue;
        if (counts != nullptr) *counts = counted;
        return samplesOf(sums.leaves(), params);
    }
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
