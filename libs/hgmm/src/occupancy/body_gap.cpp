#include "occupancy/body_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hgmm {

namespace {

/// A patch in double: centre, axes as columns, half edges.
struct Rectangle {
    Eigen::Vector3d centre, halfEdges;
    Eigen::Matrix3d axes;

    explicit Rectangle(const SurfacePatch<3>& patch) {
        for (int a = 0; a < 3; ++a) {
            centre[a] = double(patch.mean[a]);
            halfEdges[a] = double(patch.halfEdge[a]);
            for (int d = 0; d < 3; ++d) axes(d, a) = double(patch.axes[a][d]);
        }
    }
};

/// By how much a point of the rectangle's frame is beyond it, along each axis.
Eigen::Vector3d beyond(const Eigen::Vector3d& p, const Eigen::Vector3d& halfEdges) {
    return p - p.cwiseMax(-halfEdges).cwiseMin(halfEdges);
}

/// The share of the way from `p` along `d` that is nearest to a rectangle, all in its
/// frame. The squared distance is convex along it and its slope linear between the places
/// where the segment crosses the planes of the rectangle's edges.
double nearestShare(const Eigen::Vector3d& p, const Eigen::Vector3d& d,
                    const Eigen::Vector3d& halfEdges) {
    std::array<double, 6> stops{0.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    std::size_t count = 1;
    for (int a = 1; a < 3; ++a)
        for (const double edge : {-halfEdges[a], halfEdges[a]}) {
            const double share = (edge - p[a]) / d[a];
            if (share > 0 && share < 1) stops[count++] = share;
        }
    std::sort(stops.begin(), stops.end());
    const auto slope = [&](double share) {
        return beyond(p + share * d, halfEdges).dot(d);
    };
    double before = slope(0.0);
    if (before >= 0) return 0.0;
    for (std::size_t i = 1; i < stops.size(); ++i) {
        const double after = slope(stops[i]);
        if (after >= 0)
            return stops[i] - (stops[i] - stops[i - 1]) * after / (after - before);
        before = after;
    }
    return 1.0;
}

}  // namespace

double gapTo(const Capsule& body, const SurfacePatch<3>& patch) {
    const Rectangle rectangle(patch);
    const Eigen::Vector3d from =
        rectangle.axes.transpose() * (body.from - rectangle.centre);
    const Eigen::Vector3d along = rectangle.axes.transpose() * (body.to - body.from);
    const double share = nearestShare(from, along, rectangle.halfEdges);
    return beyond(from + share * along, rectangle.halfEdges).norm() - body.radius_m;
}

double gapTo(const OrientedBox& body, const SurfacePatch<3>& patch) {
    const Rectangle rectangle(patch);
    const Eigen::Vector3d offset = rectangle.centre - body.centre;
    double widest = -std::numeric_limits<double>::infinity();
    const auto tryAxis = [&](const Eigen::Vector3d& axis) {
        // Of parallel edges: other axes part the bodies if any does.
        const double length = axis.norm();
        if (length < 1e-9) return;
        const double reach =
            (body.axes.transpose() * axis).cwiseAbs().dot(body.halfEdges) +
            (rectangle.axes.transpose() * axis).cwiseAbs().dot(rectangle.halfEdges);
        widest = std::max(widest, (std::abs(offset.dot(axis)) - reach) / length);
    };
    for (int a = 0; a < 3; ++a) {
        tryAxis(body.axes.col(a));
        tryAxis(rectangle.axes.col(a));
        for (int b = 0; b < 3; ++b) tryAxis(body.axes.col(a).cross(rectangle.axes.col(b)));
    }
    return widest;
}

Eigen::Vector3d reachOf(const Capsule& body) {
    return (0.5 * (body.to - body.from)).cwiseAbs().array() + body.radius_m;
}
Eigen::Vector3d reachOf(const OrientedBox& body) {
    return body.axes.cwiseAbs() * body.halfEdges;
}
Eigen::Vector3d centreOf(const Capsule& body) {
    return 0.5 * (body.from + body.to);
}
Eigen::Vector3d centreOf(const OrientedBox& body) {
    return body.centre;
}

}  // namespace hgmm
