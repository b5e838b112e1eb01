#pragma once
#include <cstddef>
#include <memory>

#include "hgmm/export.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// How well a measured point agrees with the surfaces of a map, for localisation: with an
/// outlier floor,
///   p = outlierRatio + (1 - outlierRatio) max_j k(d_j^2).
/// k(d^2) = 1 / (1 + 1/2 d^2), lowered and scaled to be 1 at 0 and 0 from where it would
/// add half of the outlier ratio, or from d = 20. Near 0 it is the Gaussian exp(-1/2 d^2);
/// its tail, that of a Gaussian whose width is not known, still leads towards a surface
/// from several widths away, where the Gaussian is flat. A component counts as a patch: the
/// rectangle in its principal plane that has its variances there, with half edges h =
/// sqrt(3) sigma. d_j^2 sums, over the principal axes, the squared distance to the patch
/// over
///   sigma_normal^2 + kernelWidth_m^2 (kernelWidth_m^2 / (kernelWidth_m^2 + h^2))^2
/// with h = 0 for the normal. Where sigma is below a quarter of the largest, the patch is
/// more and more of a line: h shrinks to 0 at an eighth, and sigma takes the place of
/// sigma_normal. So p is the same all along a wall, where Gaussians would draw
/// points towards the middles of the pieces that it happens to be cut into; and ends of
/// long pieces are sharp, as they often end only because no more was seen yet: soft ends
/// would draw points of the next piece, so that motion is underestimated. p depends neither
/// on the size of the map nor on how often a surface was seen, and is comparable between
/// poses.
class HGMM_EXPORT SurfaceLikelihood {
 public:
    /// @param kernelWidth_m pose search radius [m], >= 0: wider is smoother
    /// @param outlierRatio share of measurements that the map does not explain, in (0, 1)
    /// Throws std::invalid_argument for values outside.
    SurfaceLikelihood(const Mixture<3>& mixture, double kernelWidth_m, double outlierRatio);
    SurfaceLikelihood(const SurfaceLikelihood& o);
    SurfaceLikelihood(SurfaceLikelihood&& o) noexcept;
    SurfaceLikelihood& operator=(const SurfaceLikelihood& o);
    SurfaceLikelihood& operator=(SurfaceLikelihood&& o) noexcept;
    ~SurfaceLikelihood();

    /// Follows a mixture that has changed: enters the components that are not what they
    /// were, which is much cheaper than starting anew where few are. Answers are the same.
    void update(const Mixture<3>& mixture);
    /// Whether update() would change nothing.
    bool isOf(const Mixture<3>& mixture) const;

    /// p of one point in the mixture's frame, in [outlierRatio, 1]. A point that is not
    /// finite is an outlier. Thread-safe.
    double probability(float x, float y, float z) const;

    /// log p [nat].
    double operator()(float x, float y, float z) const;

    std::size_t liveBytes() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hgmm
