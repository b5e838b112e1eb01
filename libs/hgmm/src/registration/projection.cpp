#include "hgmm/projection.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace hgmm {

namespace {

constexpr std::uint32_t kLeafSize = 4;

template <std::size_t D>
bool isFinite(const std::array<float, D>& p) {
    return std::all_of(p.begin(), p.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

template <int D>
SurfaceProjection<D>::SurfaceProjection(const Mixture<3>& mixture) {
    surfaces_.reserve(mixture.size());
    for (std::uint32_t i = 0; i < mixture.size(); ++i)
        if (const auto surface = surfaceOf(mixture, i)) surfaces_.push_back(*surface);
    if (surfaces_.empty()) return;
    nodes_.reserve(surfaces_.size());
    split(0, static_cast<std::uint32_t>(surfaces_.size()));
}

template <int D>
auto SurfaceProjection<D>::surfaceOf(const Mixture<3>& mixture, std::uint32_t i)
    -> std::optional<Surface> {
    const Gaussian<3> g = mixture[i];
    if (!g.mean.allFinite() || !g.covariance.allFinite()) return {};
    using Matrix = Eigen::Matrix<double, D, D>;
    const Matrix covariance = g.covariance.template topLeftCorner<D, D>();
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
    Surface surface;
    surface.component = i;
    for (int a = 0; a < D; ++a) {
        surface.mean[a] = static_cast<float>(g.mean[a]);
        surface.variance[a] = static_cast<float>(std::max(0.0, solver.eigenvalues()[a]));
        for (int d = 0; d < D; ++d)
            surface.axes[a][d] = static_cast<float>(solver.eigenvectors()(d, a));
    }
    return surface;
}

template <int D>
float SurfaceProjection<D>::extentAlong(const Surface& surface, int axis) {
    return axis == 0 ? 0.F : kExtentSigmas * std::sqrt(surface.variance[axis]);
}

template <int D>
auto SurfaceProjection<D>::boxOf(const Surface& surface) -> Box {
    Box box{surface.mean, surface.mean};
    for (int d = 0; d < D; ++d) {
        float half = 0;
        for (int a = 1; a < D; ++a)
            half += extentAlong(surface, a) * std::abs(surface.axes[a][d]);
        box.low[d] -= half;
        box.high[d] += half;
    }
    return box;
}

template <int D>
void SurfaceProjection<D>::split(std::uint32_t begin, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    Node node;
    node.begin = begin;
    node.end = end;
    node.box = boxOf(surfaces_[begin]);
    Box means{surfaces_[begin].mean, surfaces_[begin].mean};
    for (std::uint32_t i = begin; i < end; ++i) {
        const Box box = boxOf(surfaces_[i]);
        node.thickest_m2 = std::max(node.thickest_m2, surfaces_[i].variance[0]);
        for (int d = 0; d < D; ++d) {
            node.box.low[d] = std::min(node.box.low[d], box.low[d]);
            node.box.high[d] = std::max(node.box.high[d], box.high[d]);
            means.low[d] = std::min(means.low[d], surfaces_[i].mean[d]);
            means.high[d] = std::max(means.high[d], surfaces_[i].mean[d]);
        }
    }
    nodes_.push_back(node);
    if (end - begin <= kLeafSize) return;

    int widest = 0;
    for (int d = 1; d < D; ++d)
        if (means.high[d] - means.low[d] > means.high[widest] - means.low[widest])
            widest = d;
    const std::uint32_t middle = begin + (end - begin) / 2;
    // By index where means coincide, so that the tree is the same everywhere.
    std::nth_element(surfaces_.begin() + begin, surfaces_.begin() + middle,
                     surfaces_.begin() + end, [widest](const Surface& a, const Surface& b) {
                         return std::tie(a.mean[widest], a.component) <
                                std::tie(b.mean[widest], b.component);
                     });
    split(begin, middle);
    nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
    split(middle, end);
}

template <int D>
float SurfaceProjection<D>::squaredDistance(const Box& box, const Point& point) {
    float sum = 0;
    for (int d = 0; d < D; ++d) {
        const float out = std::max({box.low[d] - point[d], 0.F, point[d] - box.high[d]});
        sum += out * out;
    }
    return sum;
}

template <int D>
template <typename Prune, typename Visitor>
void SurfaceProjection<D>::visitNear(const Point& point, Prune&& prune,
                                     Visitor&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> pending;  // a level of the tree adds one, and halves it
    std::size_t count = 0;
    pending[count++] = 0;
    while (count > 0) {
        const std::uint32_t at = pending[--count];
        const Node& node = nodes_[at];
        if (prune(node, squaredDistance(node.box, point))) continue;
        if (node.right == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) visit(surfaces_[i]);
            continue;
        }
        // The nearer half first, so that it may spare the other.
        std::uint32_t first = at + 1, second = node.right;
        if (squaredDistance(nodes_[second].box, point) <
            squaredDistance(nodes_[first].box, point))
            std::swap(first, second);
        pending[count++] = second;
        pending[count++] = first;
    }
}

template <int D>
auto SurfaceProjection<D>::alongAxes(const Surface& surface, const Point& point) -> Point {
    Point along{};
    for (int a = 0; a < D; ++a)
        for (int d = 0; d < D; ++d)
            along[a] += surface.axes[a][d] * (point[d] - surface.mean[d]);
    return along;
}

template <int D>
auto SurfaceProjection<D>::projectionOf(const Surface& surface, const Point& offset_axes)
    -> Projection {
    Projection projection{surface.component, surface.mean, 0.F};
    for (int a = 0; a < D; ++a) {
        const float extent = extentAlong(surface, a);
        const float kept = std::clamp(offset_axes[a], -extent, extent);
        projection.squaredDistance_m2 += (offset_axes[a] - kept) * (offset_axes[a] - kept);
        for (int d = 0; d < D; ++d) projection.point[d] += kept * surface.axes[a][d];
    }
    return projection;
}

template <int D>
auto SurfaceProjection<D>::mostLikely(const Point& point, float radius_m) const
    -> std::optional<Projection> {
    if (!isFinite(point) || !(radius_m > 0)) return {};
    const float bound = radius_m * radius_m;
    const float kernelVariance_m2 = kKernelWidthPerRadius * kKernelWidthPerRadius * bound;
    std::optional<Projection> best;
    float bestMahalanobis = std::numeric_limits<float>::infinity();
    // Within the radius, (distance to the surface)^2 / (thickness^2 + kernel width^2) is a
    // lower bound of the squared Mahalanobis distance: of what is beyond the extent along
    // an axis, the share is the greater the longer the surface.
    static_assert(kKernelWidthPerRadius * kExtentSigmas >= 1);
    const auto prune = [&](const Node& node, float squaredDistance_m2) {
        return !(squaredDistance_m2 < bound) ||
               squaredDistance_m2 >
                   bestMahalanobis * (node.thickest_m2 + kernelVariance_m2);
    };
    visitNear(point, prune, [&](const Surface& surface) {
        const Point offset = alongAxes(surface, point);
        float mahalanobis = 0;
        for (int a = 0; a < D; ++a)
            mahalanobis +=
                offset[a] * offset[a] / (surface.variance[a] + kernelVariance_m2);
        const bool better =
            mahalanobis < bestMahalanobis ||
            (best && mahalanobis == bestMahalanobis && surface.component < best->component);
        if (!better) return;
        const Projection projection = projectionOf(surface, offset);
        if (!(projection.squaredDistance_m2 < bound)) return;
        best = projection;
        bestMahalanobis = mahalanobis;
    });
    return best;
}

template <int D>
auto SurfaceProjection<D>::nearest(const Point& point) const -> std::optional<Projection> {
    if (!isFinite(point)) return {};
    std::optional<Projection> best;
    float bound = std::numeric_limits<float>::infinity();
    const auto prune = [&](const Node&, float squaredDistance_m2) {
        return !(squaredDistance_m2 < bound);
    };
    visitNear(point, prune, [&](const Surface& surface) {
        const Projection projection = projectionOf(surface, alongAxes(surface, point));
        if (!(projection.squaredDistance_m2 < bound)) return;
        best = projection;
        bound = projection.squaredDistance_m2;
    });
    return best;
}

template <int D>
auto SurfaceProjection<D>::neighbours(const Point& point, std::size_t count,
                                      float maxSquaredDistance_m2) const
    -> std::vector<Projection> {
    std::vector<Projection> kept;  // a heap, the farthest first
    if (count == 0 || !isFinite(point)) return kept;
    const auto isCloser = [](const Projection& a, const Projection& b) {
        return std::tie(a.squaredDistance_m2, a.component) <
               std::tie(b.squaredDistance_m2, b.component);
    };
    float bound = maxSquaredDistance_m2;
    const auto prune = [&](const Node&, float squaredDistance_m2) {
        return !(squaredDistance_m2 <= bound);
    };
    visitNear(point, prune, [&](const Surface& surface) {
        const Projection projection = projectionOf(surface, alongAxes(surface, point));
        if (!(projection.squaredDistance_m2 <= bound)) return;
        if (kept.size() == count) {
            if (!isCloser(projection, kept.front())) return;
            std::pop_heap(kept.begin(), kept.end(), isCloser);
            kept.pop_back();
        }
        kept.push_back(projection);
        std::push_heap(kept.begin(), kept.end(), isCloser);
        if (kept.size() == count) bound = kept.front().squaredDistance_m2;
    });
    std::sort_heap(kept.begin(), kept.end(), isCloser);
    return kept;
}

template <int D>
auto SurfaceProjection<D>::bounds() const -> std::optional<std::pair<Point, Point>> {
    if (surfaces_.empty()) return {};
    std::pair<Point, Point> corners{surfaces_[0].mean, surfaces_[0].mean};
    for (const Surface& surface : surfaces_)
        for (int d = 0; d < D; ++d) {
            float half = 0;
            for (int a = 0; a < D; ++a)
                half += kExtentSigmas * std::sqrt(surface.variance[a]) *
                        std::abs(surface.axes[a][d]);
            corners.first[d] = std::min(corners.first[d], surface.mean[d] - half);
            corners.second[d] = std::max(corners.second[d], surface.mean[d] + half);
        }
    return corners;
}

template <int D>
std::size_t SurfaceProjection<D>::liveBytes() const {
    return surfaces_.capacity() * sizeof(Surface) + nodes_.capacity() * sizeof(Node);
}

template class SurfaceProjection<2>;
template class SurfaceProjection<3>;

}  // namespace hgmm
