#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/box_index.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// How well a measured point agrees with the surfaces of a map, for localisation: with an
/// outlier floor,
///   p = outlierRatio + (1 - outlierRatio) max_j exp(-1/2 d_j^2 / s_j^2),
/// d_j the distance to the patch of component j: the rectangle in its principal plane that
/// has its variances along the other two axes (half edges of sqrt(3) sigma); s_j^2 its
/// variance along the normal plus `softeningStd_m`^2. Along a wall, p is the same
/// everywhere: Gaussians would draw points towards the middle of the pieces that the wall
/// happens to be cut into. It depends neither on the size of the map nor on how often a
/// surface was seen, and is comparable between poses.
class SurfaceLikelihood {
 public:
    /// @param softeningStd_m pose search radius [m], >= 0: wider is smoother
    /// @param outlierRatio share of measurements that the map does not explain, in (0, 1)
    /// Throws std::invalid_argument for values outside.
    SurfaceLikelihood(const Mixture<3>& mixture, double softeningStd_m,
                      double outlierRatio);

    /// Follows a mixture that has changed: enters the components that are not what they
    /// were, which is much cheaper than starting anew where few are. Answers are the same.
    void update(const Mixture<3>& mixture);

    /// p of one point in the mixture's frame, in [outlierRatio, 1]. What adds less than a
    /// fiftieth of the outlier ratio is left out. A point that is not finite is an outlier.
    /// Thread-safe.
    double probability(float x, float y, float z) const;

    /// log p [nat].
    double operator()(float x, float y, float z) const;

    std::size_t liveBytes() const;

 private:
    /// In multiples of s_j.
    struct Patch {
        std::array<float, 3> mean{};  ///< [m]
        /// Principal axes over s_j, the normal first.
        std::array<std::array<float, 3>, 3> axes{};
        std::array<float, 2> halfEdge{};  ///< along axes 1 and 2
    };
    using Moments = std::array<float, 3 + Mixture<3>::packed>;

    static Moments momentsOf(const Mixture<3>& mixture, std::size_t i);
    void enter(const Mixture<3>& mixture, std::uint32_t i);
    static float squaredDistance(const Patch& patch, float x, float y, float z);

    double softeningVariance_m2_;
    double outlierRatio_;
    float reach_;  ///< farther patches are left out [s_j]
    std::vector<Patch> patches_;
    std::vector<Moments> moments_;  ///< what the patches were made of
    BoxIndex boxes_;
};

}  // namespace hgmm
