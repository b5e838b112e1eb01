#include "hgmm/filter.h"

#include <algorithm>

#include "four.h"
#include "hgmm/require.h"
#include "leaf_table.h"

namespace hgmm {

namespace {

/// Moments of the points of one leaf.
struct Sums {
    Two xy{};                       ///< sums of dx, dy [m]
    Two zn{};                       ///< sum of dz [m], count
    Two xx_xy{}, yy_yz{}, zz_xz{};  ///< sums of products [m^2]

    void add(double dx, double dy, double dz) {
        xy += Two{dx, dy};
        zn += Two{dz, 1.0};
        xx_xy += Two{dx, dy} * dx;
        yy_yz += Two{dy, dz} * dy;
        zz_xz += Two{dz, dx} * dz;
    }
    double count() const { return zn[1]; }
    Eigen::Vector3d sum() const { return {xy[0], xy[1], zn[0]}; }
    Eigen::Matrix3d sumOuter() const {
        Eigen::Matrix3d m;
        m << xx_xy[0], xx_xy[1], zz_xz[1],  //
            xx_xy[1], yy_yz[0], yy_yz[1],   //
            zz_xz[1], yy_yz[1], zz_xz[0];
        return m;
    }
};

Gaussian<3> sampleOf(const Leaf<Sums>& leaf, const FilterParams& params) {
    const Sums& sums = leaf.sums;
    Gaussian<3> g;
    g.support = sums.count();
    const Eigen::Vector3d offset = sums.sum() / sums.count();
    const Eigen::Matrix3d outer = sums.sumOuter();
    for (int row = 0; row < 3; ++row)
        for (int col = row; col < 3; ++col)
            g.covariance(row, col) = g.covariance(col, row) =
                outer(row, col) / sums.count() - offset[row] * offset[col];
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
