#include "hgmm/filter.h"

#include <algorithm>
#include <array>

#include "hgmm/require.h"
#include "leaf_table.h"

namespace hgmm {

namespace {

/// Moments of the points of one leaf.
struct Sums {
    double count = 0;
    std::array<double, 3> sum{};
    std::array<double, 6> sumOuter{};

    void add(double dx, double dy, double dz) {
        count += 1;
        sum[0] += dx, sum[1] += dy, sum[2] += dz;
        sumOuter[0] += dx * dx, sumOuter[1] += dx * dy, sumOuter[2] += dx * dz;
        sumOuter[3] += dy * dy, sumOuter[4] += dy * dz, sumOuter[5] += dz * dz;
    }
};

Gaussian<3> sampleOf(const Leaf<Sums>& leaf, const FilterParams& params) {
    const Sums& sums = leaf.sums;
    Gaussian<3> g;
    g.support = sums.count;
    Eigen::Vector3d offset(sums.sum[0], sums.sum[1], sums.sum[2]);
    offset /= sums.count;
    for (int row = 0, k = 0; row < 3; ++row)
        for (int col = row; col < 3; ++col, ++k)
            g.covariance(row, col) = g.covariance(col, row) =
                sums.sumOuter[k] / sums.count - offset[row] * offset[col];
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
    FilterCounts counted;
    const auto table = sumLeaves<Sums>(scan, params, counted,
                                       [](Sums& sums, std::size_t, double dx, double dy,
                                          double dz) { sums.add(dx, dy, dz); });
    Mixture<3> samples;
    samples.reserve(table.leaves().size());
    for (const Leaf<Sums>& filled : table.leaves())
        samples.pushBack(sampleOf(filled, params));
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
