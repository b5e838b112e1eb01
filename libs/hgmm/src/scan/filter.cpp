#include "hgmm/scan.h"

#include <algorithm>

#include "base/simd.h"
#include "hgmm/params.h"
#include "scan/voxel_table.h"

namespace hgmm {

namespace {

/// Moments of the points of one leaf.
struct Sums {
    Double2 xy{};                       ///< sums of dx, dy [m]
    Double2 zn{};                       ///< sum of dz [m], count
    Double2 xx_xy{}, yy_yz{}, zz_xz{};  ///< sums of products [m^2]

    void add(double dx, double dy, double dz) {
        xy += Double2{dx, dy};
        zn += Double2{dz, 1.0};
        xx_xy += Double2{dx, dy} * dx;
        yy_yz += Double2{dy, dz} * dy;
        zz_xz += Double2{dz, dx} * dz;
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
