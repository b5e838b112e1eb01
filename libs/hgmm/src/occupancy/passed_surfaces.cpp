#include "occupancy/passed_surfaces.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "occupancy/openings.h"

namespace hgmm {

namespace {

/// A tile, evenly filled, ends at sqrt(3) standard deviations.
constexpr double kTileReach2 = 3.0;
/// Pieces of surfaces are at least so many times wider than thick; others, as bushes and
/// corners, let rays pass and are still there.
constexpr double kWidthPerThickness = 7.0;
/// Range noise and shallow steps, as of a door in its frame, make narrow pieces thick: less
/// thick ones need be four times wider only [m].
constexpr double kNoise_m = 0.04, kWidthPerNoise = 4.0;
/// Rays farther apart do not tell: too few end beside an edge [m].
constexpr double kSparsest_m = 0.125;
/// Rays end so many standard deviations behind what they go through, and by what poses may
/// be off besides: at 1 m, growing with the root of the range [m], and of the range [1].
constexpr double kBehindSigmas = 3.0, kErrorAtOneMetre_m = 0.02, kErrorPerMetre = 0.015;
/// A surface is felt so far from its plane [standard deviations].
constexpr double kFeltSigmas = 4.0;

/// A component as a piece of a surface.
struct Piece {
    Eigen::Vector3d normal;  ///< unit vector
    double thickness_m;      ///< standard deviation along it
    double width_m;          ///< the smaller one across it, or that in the plane of rays
};

/// @param normalOfRays of a planar laser; else zero
Piece pieceOf(const Gaussian<3>& component, const Eigen::Vector3d& normalOfRays) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
        Eigen::Matrix3d(component.covariance));
    const Eigen::Vector3d sigma = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    if (normalOfRays.isZero()) return {eigen.eigenvectors().col(0), sigma[0], sigma[1]};
    const Eigen::Vector3d across =
        normalOfRays.cross(eigen.eigenvectors().col(2)).normalized();
    const Eigen::Matrix3d covariance = component.covariance;
    return {across, std::sqrt(across.dot(covariance * across)), sigma[2]};
}

/// The way of rays through one component.
class Passage {
 public:
    Passage(const Gaussian<3>& component, const ComponentIndex::Factor& factor,
            const Eigen::Vector3d& sensorOrigin, const Coverage::Rays& rays)
        : component_(component), factor_(factor), origin_(sensorOrigin), rays_(rays) {}

    void mark(const RayImage::Ray& ray, Coverage& passed) {
        if (!hasPiece_) setPiece();
        if (!isWide_) return;
        const std::optional<double> range_m = goesThrough(ray);
        if (!range_m) return;
        const double spacing_m = rays_.spacing_rad() * *range_m;
        if (spacing_m > kSparsest_m) return;
        const int octave = Openings::octaveAt(*range_m, rays_);
        if (2.0 * std::sqrt(kTileReach2) * piece_.width_m < powerOfTwo(octave)) return;
        markAbout(origin_ + *range_m * ray.direction, octave, spacing_m / 2, passed);
    }

 private:
    void setPiece() {
        piece_ = pieceOf(component_, rays_.normal());
        height_m_ = piece_.normal.dot(Eigen::Vector3d(component_.mean) - origin_);
        const double most =
            piece_.thickness_m < kNoise_m ? kWidthPerNoise : kWidthPerThickness;
        isWide_ = piece_.thickness_m * most <= piece_.width_m;
        hasPiece_ = true;
    }

    /// Marks the cells about a place in which the piece is felt. The ray stands for it up
    /// to half way to the next rays.
    void markAbout(const Eigen::Vector3d& place, int octave, double half_m,
                   Coverage& passed) const {
        const double edge_m = powerOfTwo(octave);
        const Eigen::Vector3d half =
            std::max(kFeltSigmas * piece_.thickness_m, edge_m / 4) * piece_.normal;
        const bool isPlanar = !rays_.normal().isZero();
        const int steps = std::max(1, static_cast<int>(std::ceil(half_m / edge_m)));
        const Eigen::Vector3d upright =
            isPlanar ? rays_.normal() : Eigen::Vector3d(piece_.normal.unitOrthogonal());
        // A planar laser marks a layer of cells, as coverage does.
        const Eigen::Vector3d up = (isPlanar ? edge_m / 4 : half_m / steps) * upright;
        const Eigen::Vector3d aside = half_m / steps * piece_.normal.cross(upright);
        const int rows = isPlanar ? 1 : steps;
        for (int i = -rows; i <= rows; ++i)
            for (int j = -steps; j <= steps; ++j) {
                const Eigen::Vector3d at = place + i * up + j * aside;
                passed.markSegment(octave, at - half, at + half);
            }
    }

    /// Distance at which it does.
    std::optional<double> goesThrough(const RayImage::Ray& ray) const {
        const double approach = piece_.normal.dot(ray.direction);
        const double range_m = height_m_ / approach;
        if (!(range_m > 0 && range_m < ray.length_m)) return std::nullopt;
        const double clear_m = kBehindSigmas * piece_.thickness_m +
                               kErrorAtOneMetre_m * std::sqrt(range_m) +
                               kErrorPerMetre * range_m;
        if (std::abs(height_m_) < clear_m ||
            (ray.length_m - range_m) * std::abs(approach) < clear_m)
            return std::nullopt;
        const Eigen::Vector3f place = (origin_ + range_m * ray.direction).cast<float>();
        if (!(factor_.squaredMahalanobis(place.data()) <= float(kTileReach2)))
            return std::nullopt;
        return range_m;
    }

    const Gaussian<3>& component_;
    const ComponentIndex::Factor& factor_;
    const Eigen::Vector3d& origin_;
    const Coverage::Rays& rays_;
    bool hasPiece_ = false;  ///< the first ray makes it
    bool isWide_ = false;
    Piece piece_{Eigen::Vector3d::Zero(), 0.0, 0.0};
    double height_m_ = 0.0;  ///< of its mean over the sensor, along its normal
};

}  // namespace

Coverage passedSurfaces(const Mixture<3>& surfaces, const ComponentIndex& index,
                        const std::vector<std::uint32_t>& near, float minSupport,
                        const RayImage& image, const Coverage::Rays& rays) {
    Coverage passed;
    for (const std::uint32_t i : near) {
        if (surfaces.support[i] < minSupport) continue;
        const Gaussian<3> component = surfaces[i];
        const Eigen::Vector3d towards = component.mean - image.origin();
        const double range_m = towards.norm(),
                     extent_m = std::sqrt(kTileReach2 * component.covariance.trace());
        if (!(range_m > extent_m)) continue;
        Passage passage(component, index.factor(i), image.origin(), rays);
        image.visitAround(towards / range_m, std::min(0.6, extent_m / range_m),
                          range_m - extent_m,
                          [&](const RayImage::Ray& ray) { passage.mark(ray, passed); });
    }
    return passed;
}

}  // namespace hgmm
