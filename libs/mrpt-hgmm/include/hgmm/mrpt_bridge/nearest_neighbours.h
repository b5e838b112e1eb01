#pragma once
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPoint3D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/map.h"
#include "hgmm/mrpt_bridge/mrpt_compat.h"

namespace hgmm::mrpt_bridge {

class SurfaceMatching;

/// Neighbours of a point among the surfaces of a map, as
/// mrpt::maps::NearestNeighborsCapable asks for them: for mp2p_icp and MOLA. MRPT 2.5 has
/// no such interface; there, the functions are the map's own.
///
/// A neighbour is the point nearest to the query on the surface of a component at level 0
/// (SurfaceProjection), so each component is at most one neighbour. The means would be
/// sparse points somewhere on large surfaces, half a metre off along them; with the nearest
/// point, pairing points with points moves a scan along a wall freely, as pairing with
/// planes does. Of several neighbours, the first is what the point sees, the others lie on
/// the surfaces around.
///
/// An ID has the component's index in `model().mixture()` in its low 32 bits, and above
/// them a number for the cell, of edge kCell_m, where the neighbour lies: a matcher that
/// takes each ID once keeps the best point for each cell. (With one ID a component, it
/// would keep points that are on their surfaces already, and hardly move.) IDs do not
/// survive a change of the map.
///
/// In 2D, surfaces are those of the components' horizontal marginals, line segments,
/// whatever their heights: for maps of planar lasers.
///
/// Points are in the map frame [m]. They are floats there; squared distances [m^2] are
/// computed before rounding, and stay exact far from the map frame's origin. Neighbours
/// come nearest first, the lower index first of equals. A point that is not finite has
/// none. Const calls may come from several threads; the first after a change makes the
/// surfaces, for which the others wait.
class NearestNeighbours : public NearestNeighboursInterface {
 public:
    using Point2 = mrpt::math::TPoint2Df;
    using Point3 = mrpt::math::TPoint3Df;

    /// @name mrpt::maps::NearestNeighborsCapable
    /// @{

    static constexpr double kCell_m = 0.1;  ///< edge of the cells that IDs tell apart [m]

    /// False: they are IDs.
    [[nodiscard]] bool nn_has_indices_or_ids() const HGMM_OVERRIDE_SINCE_2_11_3 {
        return false;
    }
    /// Number of components at level 0.
    [[nodiscard]] std::size_t nn_index_count() const HGMM_OVERRIDE_SINCE_2_11_3;
    /// Makes the surfaces, which queries would otherwise do.
    void nn_prepare_for_2d_queries() const HGMM_OVERRIDE_SINCE_2_11_3;
    void nn_prepare_for_3d_queries() const HGMM_OVERRIDE_SINCE_2_11_3;

    /// @return false, and nothing else changed, if there is no neighbour.
    [[nodiscard]] bool nn_single_search(
        const Point3& query, Point3& result, float& out_dist_sqr,
        std::uint64_t& resultIndexOrID) const HGMM_OVERRIDE_SINCE_2_11_3;
    [[nodiscard]] bool nn_single_search(
        const Point2& query, Point2& result, float& out_dist_sqr,
        std::uint64_t& resultIndexOrID) const HGMM_OVERRIDE_SINCE_2_11_3;

    /// The N nearest, fewer if there are fewer components.
    void nn_multiple_search(const Point3& query, const std::size_t N,
                            std::vector<Point3>& results, std::vector<float>& out_dists_sqr,
                            std::vector<std::uint64_t>& resultIndicesOrIDs) const
        HGMM_OVERRIDE_SINCE_2_11_3;
    void nn_multiple_search(const Point2& query, const std::size_t N,
                            std::vector<Point2>& results, std::vector<float>& out_dists_sqr,
                            std::vector<std::uint64_t>& resultIndicesOrIDs) const
        HGMM_OVERRIDE_SINCE_2_11_3;

    /// Those at most so far away, and of these the maxPoints nearest, unless it is 0.
    void nn_radius_search(const Point3& query, const float search_radius_sqr,
                          std::vector<Point3>& results, std::vector<float>& out_dists_sqr,
                          std::vector<std::uint64_t>& resultIndicesOrIDs,
                          std::size_t maxPoints = 0) const HGMM_OVERRIDE_SINCE_2_11_3;
    void nn_radius_search(const Point2& query, const float search_radius_sqr,
                          std::vector<Point2>& results, std::vector<float>& out_dists_sqr,
                          std::vector<std::uint64_t>& resultIndicesOrIDs,
                          std::size_t maxPoints = 0) const HGMM_OVERRIDE_SINCE_2_11_3;
    /// @}

 private:
    virtual const Map& neighboursModel() const = 0;
    virtual const SurfaceMatching& neighboursSurfaces() const = 0;

    template <typename Point>
    bool single(const Point& query, Point& result, float& squaredDistance_m2,
                std::uint64_t& index) const;
    template <typename Point>
    void several(const Point& query, std::size_t count, float maxSquaredDistance_m2,
                 std::vector<Point>& results, std::vector<float>& squaredDistances_m2,
                 std::vector<std::uint64_t>& indices) const;
};

}  // namespace hgmm::mrpt_bridge
