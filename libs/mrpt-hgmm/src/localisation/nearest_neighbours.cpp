#include "hgmm/mrpt_bridge/nearest_neighbours.h"

#include "localisation/surface_matching.h"

#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace hgmm::mrpt_bridge {

namespace {

template <typename Point>
constexpr int kDimension = std::is_same_v<Point, mrpt::math::TPoint2Df> ? 2 : 3;

template <typename Point>
auto toLocal(const Point& p_map, const Eigen::Vector3d& origin_map) {
    std::array<float, kDimension<Point>> local;
    for (std::size_t d = 0; d < local.size(); ++d)
        local[d] = static_cast<float>(double(p_map[d]) - origin_map[Eigen::Index(d)]);
    return local;
}

template <typename Point>
Point toMap(const std::array<float, kDimension<Point>>& local,
            const Eigen::Vector3d& origin_map) {
    Point p_map;
    for (std::size_t d = 0; d < local.size(); ++d)
        p_map[d] = static_cast<float>(origin_map[Eigen::Index(d)] + double(local[d]));
    return p_map;
}

/// ID of a component's cell where a projection is.
template <int D>
std::uint64_t idOf(const typename SurfaceProjection<D>::Projection& projection) {
    std::uint32_t cell = 0;  // 11 bits an axis in 2D, 10 in 3D: unique within 100 m
    for (int d = 0; d < D; ++d) {
        const auto at = static_cast<std::int64_t>(
            std::floor(double(projection.point[d]) / NearestNeighbours::kCell_m));
        cell =
            cell << (D == 2 ? 11 : 10) | (std::uint32_t(at) & (D == 2 ? 0x7FFU : 0x3FFU));
    }
    return std::uint64_t{cell} << 32 | projection.component;
}

}  // namespace

std::size_t NearestNeighbours::nn_index_count() const {
    return neighboursModel().mixture().size();
}

void NearestNeighbours::nn_prepare_for_2d_queries() const {
    neighboursSurfaces().surfacesOf<2>(neighboursModel());
}

void NearestNeighbours::nn_prepare_for_3d_queries() const {
    neighboursSurfaces().surfacesOf<3>(neighboursModel());
}

template <typename Point>
bool NearestNeighbours::single(const Point& query, Point& result, float& squaredDistance_m2,
                               std::uint64_t& index) const {
    const Map& map = neighboursModel();
    const auto surfaces = neighboursSurfaces().surfacesOf<kDimension<Point>>(map);
    const auto projection = surfaces->nearest(toLocal(query, map.origin()));
    if (!projection) return false;
    result = toMap<Point>(projection->point, map.origin());
    squaredDistance_m2 = projection->squaredDistance_m2;
    index = idOf<kDimension<Point>>(*projection);
    return true;
}

template <typename Point>
void NearestNeighbours::several(const Point& query, std::size_t count,
                                float maxSquaredDistance_m2, std::vector<Point>& results,
                                std::vector<float>& squaredDistances_m2,
                                std::vector<std::uint64_t>& indices) const {
    const Map& map = neighboursModel();
    const auto surfaces = neighboursSurfaces().surfacesOf<kDimension<Point>>(map);
    results.clear();
    squaredDistances_m2.clear();
    indices.clear();
    for (const auto& projection :
         surfaces->neighbours(toLocal(query, map.origin()), count, maxSquaredDistance_m2)) {
        results.push_back(toMap<Point>(projection.point, map.origin()));
        squaredDistances_m2.push_back(projection.squaredDistance_m2);
        indices.push_back(idOf<kDimension<Point>>(projection));
    }
}

bool NearestNeighbours::nn_single_search(const Point3& query, Point3& result,
                                         float& out_dist_sqr,
                                         std::uint64_t& resultIndexOrID) const {
    return single(query, result, out_dist_sqr, resultIndexOrID);
}

bool NearestNeighbours::nn_single_search(const Point2& query, Point2& result,
                                         float& out_dist_sqr,
                                         std::uint64_t& resultIndexOrID) const {
    return single(query, result, out_dist_sqr, resultIndexOrID);
}

void NearestNeighbours::nn_multiple_search(
    const Point3& query, const std::size_t N, std::vector<Point3>& results,
    std::vector<float>& out_dists_sqr,
    std::vector<std::uint64_t>& resultIndicesOrIDs) const {
    several(query, N, std::numeric_limits<float>::infinity(), results, out_dists_sqr,
            resultIndicesOrIDs);
}

void NearestNeighbours::nn_multiple_search(
    const Point2& query, const std::size_t N, std::vector<Point2>& results,
    std::vector<float>& out_dists_sqr,
    std::vector<std::uint64_t>& resultIndicesOrIDs) const {
    several(query, N, std::numeric_limits<float>::infinity(), results, out_dists_sqr,
            resultIndicesOrIDs);
}

void NearestNeighbours::nn_radius_search(const Point3& query, const float search_radius_sqr,
                                         std::vector<Point3>& results,
                                         std::vector<float>& out_dists_sqr,
                                         std::vector<std::uint64_t>& resultIndicesOrIDs,
                                         std::size_t maxPoints) const {
    several(query, maxPoints == 0 ? nn_index_count() : maxPoints, search_radius_sqr,
            results, out_dists_sqr, resultIndicesOrIDs);
}

void NearestNeighbours::nn_radius_search(const Point2& query, const float search_radius_sqr,
                                         std::vector<Point2>& results,
                                         std::vector<float>& out_dists_sqr,
                                         std::vector<std::uint64_t>& resultIndicesOrIDs,
                                         std::size_t maxPoints) const {
    several(query, maxPoints == 0 ? nn_index_count() : maxPoints, search_radius_sqr,
            results, out_dists_sqr, resultIndicesOrIDs);
}

}  // namespace hgmm::mrpt_bridge

auto mrpt::maps::CHGMMOccupancyMap::boundingBox() const -> mrpt::math::TBoundingBoxf {
    using hgmm::mrpt_bridge::toMap;
    const auto corners = caches_.matching().surfacesOf<3>(model_)->bounds();
    if (!corners) return {};
    return {toMap<mrpt::math::TPoint3Df>(corners->first, model_.origin()),
            toMap<mrpt::math::TPoint3Df>(corners->second, model_.origin())};
}
