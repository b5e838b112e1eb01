#include "fusion/carving.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fusion/piece.h"

namespace hgmm {

namespace {

/// The nearest rays about a component end so many of its standard deviations behind it.
constexpr double kAroundSigmas = 3.0;
/// So many rays through the core of a component, of which this share ends behind it, say
/// that it is gone.
constexpr int kLeastRays = 3;
constexpr double kPassingShare = 0.95;
/// A sheet of whose rays this share end on it stays: openings tell where the others went
/// through. A tile, evenly filled, ends at sqrt(3) standard deviations.
constexpr double kHitShare = 0.2, kTileReach = 1.7320508;

/// A component as a sensor sees it.
struct View {
    Eigen::Vector3d towards;  ///< from the sensor to its mean [m]
    double range_m;           ///< length of that
    Eigen::Matrix3d factor;   ///< L of the covariance L L^T
    double sigma_m;           ///< along the ray to the mean
};

/// Whether the nearest rays about the mean and most of the sigma points all end behind.
bool allAroundPass(const View& view, const RayImage& image) {
    const double margin_m = kAroundSigmas * view.sigma_m;
    const auto passes = [&](const Eigen::Vector3d& towards) {
        return image.nearestRange(towards) > towards.norm() + margin_m;
    };
    if (!passes(view.towards)) return false;
    // Points whose moments are the component's: mean +- sqrt(3) columns of the factor.
    int passed = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-kTileReach, kTileReach})
            passed += passes(view.towards + side * view.factor.col(axis)) ? 1 : 0;
    return passed >= 4;
}

/// How many rays pass within some standard deviations of the mean and end so far behind
/// their nearest point to it, or before: negative.
int countRays(const View& view, const RayImage& image, double sigmas, double behind_m) {
    const auto factor = view.factor.triangularView<Eigen::Lower>();
    const Eigen::Vector3d mean = factor.solve(view.towards);
    const auto cone = RayImage::Cone::ofTangent(sigmas * view.factor.norm() / view.range_m);
    int rays = 0;
    image.visitAround(view.towards / view.range_m, cone,
                      view.range_m - sigmas * view.sigma_m + behind_m,
                      [&](const RayImage::Ray& ray) {
                          const Eigen::Vector3d along = factor.solve(ray.direction);
                          const double foot_m = mean.dot(along) / along.squaredNorm();
                          if ((mean - foot_m * along).squaredNorm() <= sigmas * sigmas &&
                              ray.length_m > foot_m + behind_m)
                              ++rays;
                      });
    return rays;
}

/// Whether rays through the core of the component, one standard deviation, end behind it,
/// whatever the rays beside it meet: the floor before it, for instance.
bool coreIsPassed(const View& view, const RayImage& image) {
    const double margin_m = clearBehind(view.sigma_m, view.range_m);
    // Few rays are long enough to pass what is there, so these are asked first.
    const int passing = countRays(view, image, 1.0, margin_m);
    return passing >= kLeastRays &&
           passing >= kPassingShare * countRays(view, image, 1.0, -margin_m);
}

/// Whether a good part of the rays through the tile of a component end on it. So it is
/// where no ray goes through: those beside it do not say that it is gone.
bool isHitBeside(const View& view, const RayImage& image) {
    const double margin_m = clearBehind(view.sigma_m, view.range_m);
    const int passing = countRays(view, image, kTileReach, margin_m),
              all = countRays(view, image, kTileReach, -margin_m);
    return all - passing >= kHitShare * all;
}

}  // namespace

bool isSeenThrough(const Gaussian<3>& component, const RayImage& image,
                   const Eigen::Vector3d& normalOfRays) {
    View view;
    view.towards = component.mean - image.origin();
    view.range_m = view.towards.norm();
    if (!(view.range_m > 0)) return false;
    const Eigen::Matrix3d covariance = component.covariance;
    view.factor = covariance.llt().matrixL();
    view.sigma_m = std::sqrt(view.towards.dot(covariance * view.towards)) / view.range_m;
    const bool allPass = allAroundPass(view, image);
    if (!allPass && !coreIsPassed(view, image)) return false;
    if (!isSheet(pieceOf(component, normalOfRays))) return true;
    return allPass && !isHitBeside(view, image);
}

std::vector<std::uint32_t> seenThrough(const Mixture<3>& surfaces, const RayImage& image,
                                       const Eigen::Vector3d& normalOfRays,
                                       const std::vector<std::uint32_t>& near) {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : near)
        if (isSeenThrough(surfaces[i], image, normalOfRays)) found.push_back(i);
    return found;
}

}  // namespace hgmm
