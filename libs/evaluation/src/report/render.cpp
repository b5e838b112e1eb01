#include "hgmm/evaluation/render.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "hgmm/params.h"
#include "report/canvas.h"

namespace hgmm::evaluation {
namespace {

const Eigen::Vector3d kLight = Eigen::Vector3d(-0.4, -0.6, -0.8).normalized();

double brightnessOf(const Eigen::Vector3d& normal_view) {
    return 0.45 + 0.55 * std::max(0.0, normal_view.dot(kLight));
}

/// The frame of a mixture's means and their ellipsoids, colours by the means.
Frame frameOfEllipsoids(const std::vector<Gaussian<3>>& seen,
                        const std::vector<double>& heights_m, double sigmas) {
    if (seen.empty()) throw std::invalid_argument("an empty map has no picture");
    const auto [lowest, highest] = std::minmax_element(heights_m.begin(), heights_m.end());
    Frame frame{Eigen::Vector3d::Constant(INFINITY), Eigen::Vector3d::Constant(-INFINITY),
                *lowest, *highest};
    for (const Gaussian<3>& g : seen) {
        const Eigen::Vector3d reach = sigmas * g.covariance.diagonal().array().sqrt();
        frame.low = frame.low.cwiseMin(g.mean - reach);
        frame.high = frame.high.cwiseMax(g.mean + reach);
    }
    return frame;
}

/// The ray of a pixel, d from the mean, meets the ellipsoid d^T P d = sigmas^2 where a
/// quadratic in depth says.
void drawEllipsoid(const Gaussian<3>& g, const Rgb& colour, double sigmas, Canvas& canvas) {
    const Eigen::Matrix3d P =
        Eigen::LLT<Eigen::Matrix3d>(g.covariance).solve(Eigen::Matrix3d::Identity());
    const Canvas::Patch patch = canvas.patch(g.mean, sigmas * std::sqrt(g.covariance(0, 0)),
                                             sigmas * std::sqrt(g.covariance(1, 1)));
    for (int y = patch.y0; y <= patch.y1; ++y)
        for (int x = patch.x0; x <= patch.x1; ++x) {
            const Eigen::Vector2d d = canvas.offset(x, y, g.mean);
            const double a = P(2, 2);
            const double b = P(0, 2) * d.x() + P(1, 2) * d.y();
            const double c = d.dot(P.topLeftCorner<2, 2>() * d) - sigmas * sigmas;
            const double discriminant = b * b - a * c;
            if (!(discriminant >= 0)) continue;
            const double dz = (-b - std::sqrt(discriminant)) / a;
            const Eigen::Vector3d normal =
                (P * Eigen::Vector3d(d.x(), d.y(), dz)).normalized();
            canvas.put(x, y, g.mean.z() + dz, colour, brightnessOf(normal));
        }
}

/// Draws the sides of a cube that face the viewer: a ray enters it where it has crossed the
/// first plane of each of the three pairs.
void drawCube(const Eigen::Vector3d& centre_map, const Eigen::Matrix3d& axes, double half_m,
              Canvas& canvas) {
    const Eigen::Vector3d centre = axes * centre_map;
    const Eigen::Vector3d reach = half_m * axes.cwiseAbs().rowwise().sum();
    const Eigen::Vector3d away = axes.row(2);
    const Canvas::Patch patch = canvas.patch(centre, reach.x(), reach.y());
    const Rgb colour = canvas.colourOf(centre_map.z());
    for (int y = patch.y0; y <= patch.y1; ++y)
        for (int x = patch.x0; x <= patch.x1; ++x) {
            const Eigen::Vector2d d = canvas.offset(x, y, centre);
            const Eigen::Vector3d start = axes.topRows<2>().transpose() * d;
            double enter = -INFINITY, leave = INFINITY;
            int side = 0;
            for (int k = 0; k < 3; ++k) {
                if (std::abs(away[k]) < 1e-9) {
                    if (std::abs(start[k]) > half_m) leave = -INFINITY;
                    continue;
                }
                const double middle = -start[k] / away[k];
                const double width = half_m / std::abs(away[k]);
                if (middle - width > enter) {
                    enter = middle - width;
                    side = k;
                }
                leave = std::min(leave, middle + width);
            }
            if (enter > leave) continue;
            const Eigen::Vector3d normal = axes.col(side) * (away[side] > 0 ? -1.0 : 1.0);
            canvas.put(x, y, centre.z() + enter, colour, brightnessOf(normal));
        }
}

/// @param colourOf called with the canvas and the number of a point
template <typename ColourOf>
Picture drawPoints(const Points& points_map, const View& view, const Frame& frame,
                   ColourOf&& colourOf) {
    constexpr double radius_px = 1.2;
    const Eigen::Matrix3d axes = viewAxes(view);
    Canvas canvas(frame, view);
    const double radius_m = radius_px * canvas.metresPerPixel();
    for (std::size_t i = 0; i < points_map.size(); ++i) {
        if (!points_map[i].allFinite()) continue;
        const Eigen::Vector3d seen = axes * points_map[i];
        const Canvas::Patch patch = canvas.patch(seen, radius_m, radius_m);
        const Rgb colour = colourOf(canvas, i);
        for (int y = patch.y0; y <= patch.y1; ++y)
            for (int x = patch.x0; x <= patch.x1; ++x)
                if (canvas.offset(x, y, seen).norm() <= radius_m)
                    canvas.put(x, y, seen.z(), colour, 1.0);
    }
    canvas.shadeGaps(8.0 * canvas.metresPerPixel());
    return canvas.take();
}

/// Between the values that a share of all lie below, and above.
std::pair<double, double> innerRange(std::vector<double> values, double strayShare) {
    const auto stray =
        static_cast<std::ptrdiff_t>(strayShare * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + stray, values.end());
    const double low = values[static_cast<std::size_t>(stray)];
    std::nth_element(values.begin(), values.end() - 1 - stray, values.end());
    return {low, *(values.end() - 1 - stray)};
}

/// That range and a third of its length more on either side, within that of all values.
std::pair<double, double> widenedRange(const std::vector<double>& values,
                                       double strayShare) {
    const auto [low, high] = innerRange(values, strayShare);
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    const double margin = (high - low) / 3.0;
    return {std::max(low - margin, *lowest), std::min(high + margin, *highest)};
}

}  // namespace

Frame frameOf(const Points& points_map, const View& view, double strayShare) {
    requireValid(view);
    if (!(strayShare >= 0.0 && strayShare < 0.5))
        throw std::invalid_argument("strayShare must be in [0, 0.5)");
    const Eigen::Matrix3d axes = viewAxes(view);
    std::array<std::vector<double>, 4> coordinates;  // right, down, away, up
    for (const Eigen::Vector3d& p : points_map) {
        if (!p.allFinite()) continue;
        const Eigen::Vector3d seen = axes * p;
        for (int k = 0; k < 3; ++k)
            coordinates[static_cast<std::size_t>(k)].push_back(seen[k]);
        coordinates[3].push_back(p.z());
    }
    if (coordinates[0].empty())
        throw std::invalid_argument("there are no points to make a picture of");
    Frame frame{};
    for (int k = 0; k < 3; ++k)
        std::tie(frame.low[k], frame.high[k]) =
            widenedRange(coordinates[static_cast<std::size_t>(k)], strayShare);
    std::tie(frame.lowest_m, frame.highest_m) = innerRange(coordinates[3], strayShare);
    return frame;
}

Picture renderEllipsoids(const Mixture<3>& mixture, const View& view,
                         const Eigen::Vector3d& origin_map,
                         const std::optional<Frame>& frame) {
    requireValid(view);
    const Eigen::Matrix3d axes = viewAxes(view);
    std::vector<Gaussian<3>> seen;
    std::vector<double> heights_m;
    seen.reserve(mixture.size());
    heights_m.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        Gaussian<3> g = mixture[i];
        const Eigen::Vector3d mean_map = origin_map + g.mean;
        heights_m.push_back(mean_map.z());
        g.mean = axes * mean_map;
        g.covariance = axes * g.covariance * axes.transpose();
        seen.push_back(g);
    }
    Canvas canvas(frame ? *frame : frameOfEllipsoids(seen, heights_m, view.sigmas), view);
    for (std::size_t i = 0; i < seen.size(); ++i)
        drawEllipsoid(seen[i], canvas.colourOf(heights_m[i]), view.sigmas, canvas);
    return canvas.take();
}

Picture renderPoints(const Points& points_map, const View& view, const Frame& frame) {
    requireValid(view);
    return drawPoints(points_map, view, frame, [&](const Canvas& canvas, std::size_t i) {
        return canvas.colourOf(points_map[i].z());
    });
}

Picture renderPoints(const Points& points_map, const std::vector<Rgb>& colours,
                     const View& view, const Frame& frame) {
    requireValid(view);
    if (colours.size() != points_map.size())
        throw std::invalid_argument("as many colours as points are needed");
    return drawPoints(points_map, view, frame,
                      [&](const Canvas&, std::size_t i) { return colours[i]; });
}

Picture renderVoxels(const Points& centres_map, double edge_m, const View& view,
                     const Frame& frame) {
    requireValid(view);
    if (!(edge_m > 0.0)) throw std::invalid_argument("edge_m must be positive");
    const Eigen::Matrix3d axes = viewAxes(view);
    Canvas canvas(frame, view);
    // So large that none falls between the pixels.
    const double half_m = std::max(0.5 * edge_m, 0.75 * canvas.metresPerPixel());
    for (const Eigen::Vector3d& centre : centres_map)
        if (centre.allFinite()) drawCube(centre, axes, half_m, canvas);
    return canvas.take();
}

}  // namespace hgmm::evaluation
