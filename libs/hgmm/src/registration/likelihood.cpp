#include "hgmm/likelihood.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/simd.h"
#include "hgmm/params.h"
#include "index/body_index.h"

namespace hgmm {

namespace {

/// Thinner patches would not be finite in floats [m^2].
constexpr double kLeastVariance_m2 = 1e-12;

/// The tail ends where it would add so much of the outlier ratio.
constexpr double kTailEnd = 0.5;

/// It ends at this many widths at the latest: with a small outlier ratio it would reach
/// every patch.
constexpr double kFarthest = 20;

double reachOf(double outlierRatio) {
    return std::min(kFarthest,
                    std::sqrt(2 * (1 - outlierRatio) / (kTailEnd * outlierRatio)));
}

/// A Gaussian's, near 0, with a tail.
double kernel(float squaredDistance) {
    return 1 / (1 + 0.5 * double(squaredDistance));
}

/// Octaves by which cells are smaller than patches: most of the cells in a patch's box are
/// not touched by it. Each octave more doubles the memory for less and less speed.
constexpr int kFiner = 3;

/// A narrower kernel does not make cells smaller still: there would be several times as
/// many, hardly faster to ask [m].
constexpr double kLeastForCells_m = 0.02;

/// Cells are half as large as the space around a thin patch. Small patches share this size:
/// a query looks into one cell of each size in use.
BodyIndex::Cells cellsFor(double kernelWidth_m, double outlierRatio) {
    requireInRange("kernelWidth_m", kernelWidth_m, 0.0, 1e3);
    requireInRange("outlierRatio", outlierRatio, 1e-9, 1.0 - 1e-9);
    const double reach_m =
        std::max(kernelWidth_m, kLeastForCells_m) * reachOf(outlierRatio);
    const int octave = std::clamp(static_cast<int>(std::ceil(std::log2(reach_m))),
                                  BoxCells::kMinOctave, BoxCells::kMaxOctave);
    return {kFiner, octave};
}

/// Variance that the kernel adds along an axis [m^2]: all of it across what is thinner,
/// next to nothing along what is longer.
double widening(double halfEdge_m2, double kernelVariance_m2) {
    if (kernelVariance_m2 == 0) return 0;
    const double thin = kernelVariance_m2 / (kernelVariance_m2 + halfEdge_m2);
    return kernelVariance_m2 * thin * thin;
}

/// How far the extent along an axis is one of the surface, from 0 to 1, and not spread
/// across a line: a wall that a planar laser drew is thin in two directions, the vertical
/// and its own normal, whichever is the thinner.
double extended(double variance_m2, double largestVariance_m2) {
    constexpr double line = 1.0 / 8, strip = 1.0 / 4;
    if (!(largestVariance_m2 > 0)) return 1;
    const double aspect = std::sqrt(std::max(variance_m2, 0.0) / largestVariance_m2);
    return std::clamp((aspect - line) / (strip - line), 0.0, 1.0);
}

}  // namespace

struct SurfaceLikelihood::Impl {
    Impl(const Mixture<3>& mixture, double kernelWidth_m, double outlierRatio);

    void update(const Mixture<3>& mixture);
    bool isOf(const Mixture<3>& mixture) const;
    double probability(float x, float y, float z) const;
    std::size_t liveBytes() const;

 private:
    /// A cache line.
    struct alignas(64) Patch {
        /// Coordinate d of the principal axes, the normal first, each over the standard
        /// deviation s along it; in lane 3 that of the mean [m].
        std::array<Float4, 3> axesAndMean{};
        Float4 halfEdge{};  ///< along axes 0 to 2 [s]; none along 0; lane 3 is not used

        float mean(int d) const { return axesAndMean[d][3]; }
        float axis(int a, int d) const { return axesAndMean[d][a]; }
    };
    using Moments = std::array<float, 3 + Mixture<3>::packed>;

    static Moments momentsOf(const Mixture<3>& mixture, std::size_t i);
    void enter(const Mixture<3>& mixture, std::uint32_t i);
    /// Whether a cube may hold points that the patch has a say in.
    bool touches(const Patch& patch, const float* centre, float halfEdge) const;
    static float squaredDistance(const Patch& patch, float x, float y, float z);

    double kernelVariance_m2_;
    double outlierRatio_;
    float reach_;     ///< farther patches are left out [s]
    double tailEnd_;  ///< of the kernel, at the reach
    double height_;   ///< what the kernel is scaled by, once lowered
    std::vector<Patch> patches_;
    std::vector<Moments> moments_;  ///< what the patches were made of
    BodyIndex bodies_;
};

SurfaceLikelihood::Impl::Impl(const Mixture<3>& mixture, double kernelWidth_m,
                              double outlierRatio)
    : kernelVariance_m2_(kernelWidth_m * kernelWidth_m),
      outlierRatio_(outlierRatio),
      bodies_(cellsFor(kernelWidth_m, outlierRatio)) {
    reach_ = static_cast<float>(reachOf(outlierRatio));
    tailEnd_ = kernel(reach_ * reach_);
    height_ = (1 - outlierRatio) / (1 - tailEnd_);
    update(mixture);
}

void SurfaceLikelihood::Impl::update(const Mixture<3>& mixture) {
    const auto n = static_cast<std::uint32_t>(mixture.size());
    if (patches_.size() > n) {
        bodies_.truncate(n);
        patches_.resize(n);
        moments_.resize(n);
    }
    bodies_.reserve(n);
    patches_.reserve(n);
    moments_.reserve(n);
    for (std::uint32_t i = 0; i < n; ++i)
        if (i >= patches_.size() || moments_[i] != momentsOf(mixture, i)) enter(mixture, i);
}

bool SurfaceLikelihood::Impl::isOf(const Mixture<3>& mixture) const {
    if (moments_.size() != mixture.size()) return false;
    for (std::size_t i = 0; i < mixture.size(); ++i)
        if (moments_[i] != momentsOf(mixture, i)) return false;
    return true;
}

auto SurfaceLikelihood::Impl::momentsOf(const Mixture<3>& mixture, std::size_t i)
    -> Moments {
    Moments moments{};
    for (int d = 0; d < 3; ++d) moments[d] = mixture.mean[d][i];
    for (int k = 0; k < Mixture<3>::packed; ++k) moments[3 + k] = mixture.covariance[k][i];
    return moments;
}

void SurfaceLikelihood::Impl::enter(const Mixture<3>& mixture, std::uint32_t i) {
    const Gaussian<3> g = mixture[i];
    const Eigen::Matrix3d covariance = g.covariance;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    const double thickness_m2 = std::max(solver.eigenvalues()[0], kLeastVariance_m2);
    Patch patch;
    Eigen::Vector3d reach = Eigen::Vector3d::Zero();
    for (int a = 0; a < 3; ++a) {
        const double variance_m2 = std::max(solver.eigenvalues()[a], thickness_m2);
        const double along = a == 0 ? 0.0 : extended(variance_m2, solver.eigenvalues()[2]);
        const double halfEdge_m2 = 3 * variance_m2 * along;
        const double s =
            std::sqrt(thickness_m2 + (1 - along) * (variance_m2 - thickness_m2) +
                      widening(halfEdge_m2, kernelVariance_m2_));
        const double halfEdge = std::sqrt(halfEdge_m2);
        const Eigen::Vector3d axis = solver.eigenvectors().col(a);
        for (int d = 0; d < 3; ++d)
            patch.axesAndMean[d][a] = static_cast<float>(axis[d] / s);
        patch.halfEdge[a] = static_cast<float>(halfEdge / s);
        reach += (halfEdge + reach_ * s) * axis.cwiseAbs();
    }
    BodyIndex::Box box;
    for (int d = 0; d < 3; ++d) {
        patch.axesAndMean[d][3] = box.centre[d] = static_cast<float>(g.mean[d]);
        box.halfExtent[d] = static_cast<float>(reach[d]);
    }
    if (i == patches_.size()) {
        patches_.emplace_back();
        moments_.emplace_back();
    }
    const auto touchedBy = [this](const Patch& p) {
        return [this, &p](const float* centre, float halfEdge) {
            return touches(p, centre, halfEdge);
        };
    };
    bodies_.update(i, box, touchedBy(patch), touchedBy(patches_[i]));
    patches_[i] = patch;
    moments_[i] = momentsOf(mixture, i);
}

bool SurfaceLikelihood::Impl::touches(const Patch& patch, const float* centre,
                                      float halfEdge) const {
    for (int a = 0; a < 3; ++a) {
        float along = 0, ofCube = 0;
        for (int d = 0; d < 3; ++d) {
            along += patch.axis(a, d) * (centre[d] - patch.mean(d));
            ofCube += halfEdge * std::abs(patch.axis(a, d));
        }
        const float ofPatch = patch.halfEdge[a];
        // A margin for rounding.
        if (std::abs(along) > 1.001F * (ofPatch + reach_ + ofCube)) return false;
    }
    return true;
}

inline float SurfaceLikelihood::Impl::squaredDistance(const Patch& patch, float x, float y,
                                                      float z) {
    const Float4 along = patch.axesAndMean[0] * (x - patch.mean(0)) +
                         patch.axesAndMean[1] * (y - patch.mean(1)) +
                         patch.axesAndMean[2] * (z - patch.mean(2));
    const Float4 beyond = (along < 0.F ? -along : along) - patch.halfEdge;
    const Float4 positive = beyond < 0.F ? Float4{} : beyond;  // NaN stays
    const Float4 squared = positive * positive;
    return squared[0] + squared[1] + squared[2];
}

double SurfaceLikelihood::Impl::probability(float x, float y, float z) const {
    if (patches_.empty()) return outlierRatio_;
    float nearest = std::numeric_limits<float>::infinity();
    bodies_.visitCandidates(x, y, z, [&](std::uint32_t j) {
        nearest = std::min(nearest, squaredDistance(patches_[j], x, y, z));
    });
    // The reach itself, not that of the boxes: where cells begin must not matter.
    if (!(nearest <= reach_ * reach_)) return outlierRatio_;
    return outlierRatio_ + height_ * (kernel(nearest) - tailEnd_);
}

std::size_t SurfaceLikelihood::Impl::liveBytes() const {
    return patches_.capacity() * sizeof(Patch) + moments_.capacity() * sizeof(Moments) +
           bodies_.liveBytes();
}

SurfaceLikelihood::SurfaceLikelihood(const Mixture<3>& mixture, double kernelWidth_m,
                                     double outlierRatio)
    : impl_(std::make_unique<Impl>(mixture, kernelWidth_m, outlierRatio)) {}
SurfaceLikelihood::SurfaceLikelihood(const SurfaceLikelihood& o)
    : impl_(std::make_unique<Impl>(*o.impl_)) {}
SurfaceLikelihood::SurfaceLikelihood(SurfaceLikelihood&& o) noexcept = default;
SurfaceLikelihood& SurfaceLikelihood::operator=(const SurfaceLikelihood& o) {
    if (this != &o) impl_ = std::make_unique<Impl>(*o.impl_);
    return *this;
}
SurfaceLikelihood& SurfaceLikelihood::operator=(SurfaceLikelihood&& o) noexcept = default;
SurfaceLikelihood::~SurfaceLikelihood() = default;

void SurfaceLikelihood::update(const Mixture<3>& mixture) {
    impl_->update(mixture);
}

bool SurfaceLikelihood::isOf(const Mixture<3>& mixture) const {
    return impl_->isOf(mixture);
}

double SurfaceLikelihood::probability(float x, float y, float z) const {
    return impl_->probability(x, y, z);
}

double SurfaceLikelihood::operator()(float x, float y, float z) const {
    return std::log(probability(x, y, z));
}

std::size_t SurfaceLikelihood::liveBytes() const {
    return sizeof(Impl) + impl_->liveBytes();
}

}  // namespace hgmm
