#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// Projects points on the surfaces of a map, for matching.
///
/// A component's surface is the piece of its principal plane (through the mean, normal to
/// the axis of least variance) within `kExtentSigmas` along each of the other axes. Its
/// point nearest to a given one is the projection of that point.
///
/// With D = 2, components are their horizontal marginals and surfaces are line segments:
/// for planar lasers, whose components are lines or upright slabs. Heights do not matter.
/// A floor or a ceiling would be anywhere, so such a map is for D = 3.
///
/// Surfaces are kept in a tree of bounding boxes, because the radius of matching differs
/// from point to point and shrinks as a registration converges, whereas a grid of cells is
/// made for one radius. The cost of a query depends on the surfaces within the radius and
/// on the logarithm of their number.
template <int D>
class SurfaceProjection {
 public:
    using Point = std::array<float, D>;

    struct Projection {
        std::uint32_t component = 0;  ///< its index in the mixture
        Point point{};                ///< on its surface [m]
        float squaredDistance_m2 = 0;
    };

    static constexpr float kExtentSigmas = 2.4F;

    SurfaceProjection() = default;
    /// Data is copied. Components that are not finite have no surface.
    explicit SurfaceProjection(const Mixture<3>& mixture);

    /// Number of surfaces.
    std::size_t size() const { return surfaces_.size(); }

    /// The projection of `point` on the most likely of the surfaces that are less than
    /// `radius_m` away: that of the smallest Mahalanobis distance to a component widened by
    /// an isotropic standard deviation of kKernelWidthPerRadius * radius_m, for the pose is
    /// as uncertain as the radius says. The lower index decides between equals. Nothing, if
    /// there is none, radius_m is not positive or the point is not finite. Thread-safe.
    std::optional<Projection> mostLikely(const Point& point, float radius_m) const;

    /// The nearest projection at any distance. Nothing, if there are no surfaces or the
    /// point is not finite. Thread-safe.
    std::optional<Projection> nearest(const Point& point) const;

    /// The projections on the `count` nearest surfaces, of those whose squared distance is
    /// at most maxSquaredDistance_m2: nearest first, the lower index first of equals. None,
    /// if the point is not finite. Thread-safe.
    std::vector<Projection> neighbours(
        const Point& point, std::size_t count,
        float maxSquaredDistance_m2 = std::numeric_limits<float>::infinity()) const;

    /// Lowest and highest corner of the box around all components within `kExtentSigmas`
    /// along each of their principal axes [m]: around all surfaces, with their thickness.
    /// Nothing, if there are no surfaces.
    std::optional<std::pair<Point, Point>> bounds() const;

    static constexpr float kKernelWidthPerRadius = 0.42F;

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    struct Surface {
        Point mean{};
        std::array<Point, D> axes{};  ///< principal, by ascending variance
        Point variance{};             ///< along them [m^2]
        std::uint32_t component = 0;
    };
    struct Box {
        Point low{}, high{};
    };
    /// Surfaces begin .. end; those of an inner node are shared by the next node and
    /// nodes_[right].
    struct Node {
        Box box;
        float thickest_m2 = 0;  ///< largest variance along a normal
        std::uint32_t begin = 0, end = 0;
        std::uint32_t right = 0;  ///< 0 for leaves
    };

    static std::optional<Surface> surfaceOf(const Mixture<3>& mixture, std::uint32_t i);
    static Box boxOf(const Surface& surface);
    static float extentAlong(const Surface& surface, int axis);
    static float squaredDistance(const Box& box, const Point& point);
    static Projection projectionOf(const Surface& surface, const Point& offset_axes);
    static Point alongAxes(const Surface& surface, const Point& point);

    void split(std::uint32_t begin, std::uint32_t end);
    /// Calls visit(surface) for each below nodes that are not pruned: prune(node, squared
    /// distance to its box [m^2]).
    template <typename Prune, typename Visitor>
    void visitNear(const Point& point, Prune&& prune, Visitor&& visit) const;

    std::vector<Surface> surfaces_;  ///< in the order of the tree
    std::vector<Node> nodes_;        ///< the root first
};

extern template class HGMM_EXPORT SurfaceProjection<2>;
extern template class HGMM_EXPORT SurfaceProjection<3>;

}  // namespace hgmm
