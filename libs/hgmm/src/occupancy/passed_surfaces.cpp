#include "occupancy/passed_surfaces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "fusion/piece.h"
#include "occupancy/openings.h"

namespace hgmm {

namespace {

/// A tile, evenly filled, ends at sqrt(3) standard deviations.
constexpr double kTileReach2 = 3.0;
/// Rays farther apart do not tell: too few end beside an edge [m].
constexpr double kSparsest_m = 0.125;
/// All rays are asked for a tile that reaches farther from its mean, as a share of its
/// range: sine of 0.6 rad.
constexpr double kWidest = 0.56;
/// A surface is felt so far from its plane [standard deviations].
constexpr double kFeltSigmas = 4.0;

/// The way of rays through one component.
class Passage {
 public:
    /// @param nearest_m range at which a ray may meet it
    Passage(const Gaussian<3>& component, const ComponentIndex::Factor& factor,
            const Eigen::Vector3d& sensorOrigin, double nearest_m,
            const Coverage::Rays& rays)
        : component_(component),
          factor_(factor),
          origin_(sensorOrigin),
          nearest_m_(nearest_m),
          rays_(rays) {}

    bool isOfSheet() {
        if (!hasPiece_) setPiece();
        return isSheet_;
    }

    void mark(const RayImage::Ray& ray, Coverage& passed) {
        if (!isOfSheet()) return;
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
        outwards_ = height_m_ < 0 ? -piece_.normal : piece_.normal;
        leastClear_m_ = clearBehind(piece_.thickness_m, nearest_m_);
        isSheet_ = isSheet(piece_);
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
        // Most rays end on the piece.
        if (ray.length_m * outwards_.dot(ray.direction) <
            std::abs(height_m_) + leastClear_m_)
            return std::nullopt;
        const double approach = piece_.normal.dot(ray.direction);
        const double range_m = height_m_ / approach;
        if (!(range_m > 0 && range_m < ray.length_m)) return std::nullopt;
        const double clear_m = clearBehind(piece_.thickness_m, range_m);
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
    double nearest_m_;
    const Coverage::Rays& rays_;
    bool hasPiece_ = false;  ///< the first ray makes it
    bool isSheet_ = false;
    Piece piece_;
    double height_m_ = 0.0;      ///< of its mean over the sensor, along its normal
    Eigen::Vector3d outwards_;   ///< normal, away from the sensor
    double leastClear_m_ = 0.0;  ///< what ends nearer behind it does not go through
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
        if (!(range_m > 0)) continue;
        // A ray that goes through ends behind the nearest point of the tile.
        const double along2 = towards.dot(component.covariance * towards),
                     nearest_m =
                         std::max(0.0, range_m - std::sqrt(kTileReach2 * along2) / range_m),
                     least_m = nearest_m + clearBehind(0.0, nearest_m);
        Passage passage(component, index.factor(i), image.origin(), nearest_m, rays);
        const auto mark = [&](const RayImage::Ray& ray) {
            if (ray.length_m >= least_m) passage.mark(ray, passed);
        };
        if (extent_m < kWidest * range_m)
            image.visitAround(towards / range_m, RayImage::Cone::ofSine(extent_m / range_m),
                              least_m, mark);
        else if (passage.isOfSheet())
            image.visitAll(mark);
    }
    return passed;
}

}  // namespace hgmm
