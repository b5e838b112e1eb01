#include "occupancy/surface_patch.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hgmm {

template <int D>
std::optional<SurfacePatch<D>> patchOf(const Mixture<3>& mixture, std::uint32_t i) {
    const Gaussian<3> g = mixture[i];
    if (!g.mean.allFinite() || !g.covariance.allFinite()) return {};
    const Eigen::Matrix<double, D, D> covariance =
        g.covariance.template topLeftCorner<D, D>();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver;
    solver.computeDirect(covariance);
    SurfacePatch<D> patch;
    patch.component = i;
    patch.support = static_cast<float>(g.support);
    for (int a = 0; a < D; ++a) {
        const double std_m = std::sqrt(std::max(0.0, solver.eigenvalues()[a]));
        if (a == 0)
            patch.normalStd_m = static_cast<float>(std_m);
        else
            patch.halfEdge[a] = static_cast<float>(kPatchSigmas * std_m);
        patch.mean[a] = static_cast<float>(g.mean[a]);
        for (int d = 0; d < D; ++d)
            patch.axes[a][d] = static_cast<float>(solver.eigenvectors()(d, a));
    }
    return patch;
}

template std::optional<SurfacePatch<2>> patchOf<2>(const Mixture<3>&, std::uint32_t);
template std::optional<SurfacePatch<3>> patchOf<3>(const Mixture<3>&, std::uint32_t);

}  // namespace hgmm
