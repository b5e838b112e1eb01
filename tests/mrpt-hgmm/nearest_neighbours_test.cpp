#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "laser_room.h"
#include "lit_room.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kSigmas = 2.4;

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;
template <int D>
using QueryPoint = std::conditional_t<D == 2, mrpt::math::TPoint2Df, mrpt::math::TPoint3Df>;

template <int D>
Vector<D> vectorOf(const QueryPoint<D>& p) {
    Vector<D> v;
    for (int d = 0; d < D; ++d) v[d] = double(p[std::size_t(d)]);
    return v;
}

/// The surface of one component, as documented: the principal plane within 2.4 sigmas.
template <int D>
struct Surface {
    Vector<D> mean_map, sigmas;
    Eigen::Matrix<double, D, D> axes;

    Vector<D> nearestTo(const Vector<D>& p_map) const {
        Vector<D> along = axes.transpose() * (p_map - mean_map);
        along[0] = 0;
        for (int a = 1; a < D; ++a)
            along[a] = std::clamp(along[a], -kSigmas * sigmas[a], kSigmas * sigmas[a]);
        return mean_map + axes * along;
    }
    Vector<D> halfExtent() const { return kSigmas * (axes.cwiseAbs() * sigmas); }
};

template <int D>
std::vector<Surface<D>> surfacesOf(const hgmm::Map& map) {
    std::vector<Surface<D>> surfaces;
    for (std::size_t i = 0; i < map.mixture().size(); ++i) {
        const auto g = map.mixture()[i];
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver(
            Eigen::Matrix<double, D, D>(g.covariance.topLeftCorner<D, D>()));
        surfaces.push_back({map.origin().head<D>() + g.mean.head<D>(),
                            solver.eigenvalues().cwiseMax(0).cwiseSqrt(),
                            solver.eigenvectors()});
    }
    return surfaces;
}

/// Answers to one query, by the map or by brute force.
template <int D>
struct Neighbours {
    std::vector<QueryPoint<D>> points;
    std::vector<float> squaredDistances_m2;
    std::vector<std::uint64_t> indices;
};

/// Distances [m] to all surfaces, ascending.
template <int D>
std::vector<double> bruteForce(const std::vector<Surface<D>>& surfaces,
                               const Vector<D>& p_map) {
    std::vector<double> distances;
    for (const auto& surface : surfaces)
        distances.push_back((surface.nearestTo(p_map) - p_map).norm());
    std::sort(distances.begin(), distances.end());
    return distances;
}

/// Each answer is the point of its surface, and they are the first by distance.
template <int D>
void expectNearest(const std::vector<Surface<D>>& surfaces, const Vector<D>& p_map,
                   const Neighbours<D>& found, std::size_t count) {
    const std::vector<double> expected = bruteForce(surfaces, p_map);
    ASSERT_EQ(found.points.size(), count);
    ASSERT_EQ(found.squaredDistances_m2.size(), count);
    ASSERT_EQ(found.indices.size(), count);
    EXPECT_EQ(std::set<std::uint64_t>(found.indices.begin(), found.indices.end()).size(),
              count)
        << "each component once";
    for (std::size_t k = 0; k < count; ++k) {
        const auto component = static_cast<std::uint32_t>(found.indices[k]);
        ASSERT_LT(component, surfaces.size());
        const Vector<D> point = surfaces[component].nearestTo(p_map);
        EXPECT_LT((vectorOf<D>(found.points[k]) - point).norm(), 1e-4) << k;
        EXPECT_NEAR(std::sqrt(found.squaredDistances_m2[k]), expected[k], 1e-5) << k;
        EXPECT_NEAR((point - p_map).norm(), expected[k], 1e-5) << k;
    }
}

/// Points in and around the box of a map.
template <int D>
std::vector<QueryPoint<D>> queries(const CHGMMOccupancyMap& map, int n) {
    const auto box = map.boundingBox();
    std::mt19937 random(7);
    std::vector<QueryPoint<D>> points(static_cast<std::size_t>(n));
    for (auto& p : points)
        for (std::size_t d = 0; d < D; ++d)
            p[d] = std::uniform_real_distribution<float>(box.min[d] - 1,
                                                         box.max[d] + 1)(random);
    return points;
}

template <int D>
void expectExactness(const CHGMMOccupancyMap& map) {
    const auto surfaces = surfacesOf<D>(map.model());
    ASSERT_GT(surfaces.size(), 20U);
    EXPECT_FALSE(map.nn_has_indices_or_ids());
    EXPECT_EQ(map.nn_index_count(), surfaces.size());
    for (const auto& query : queries<D>(map, 200)) {
        const Vector<D> p_map = vectorOf<D>(query);
        Neighbours<D> one;
        one.points.resize(1);
        one.squaredDistances_m2.resize(1);
        one.indices.resize(1);
        ASSERT_TRUE(map.nn_single_search(query, one.points[0], one.squaredDistances_m2[0],
                                         one.indices[0]));
        expectNearest<D>(surfaces, p_map, one, 1);

        Neighbours<D> found;
        for (const std::size_t n : {0UL, 1UL, 5UL, 100000UL}) {
            map.nn_multiple_search(query, n, found.points, found.squaredDistances_m2,
                                   found.indices);
            expectNearest<D>(surfaces, p_map, found, std::min(n, surfaces.size()));
        }
        // Between two distances, so that rounding decides nothing.
        const std::vector<double> all = bruteForce(surfaces, p_map);
        for (const std::size_t n : {std::size_t{0}, std::size_t{7}, all.size() - 1}) {
            const double radius_m = n == 0 ? 0.5 * all[0] : 0.5 * (all[n - 1] + all[n]);
            if (n > 0 && all[n] - all[n - 1] < 1e-4) continue;
            const auto squared = static_cast<float>(radius_m * radius_m);
            map.nn_radius_search(query, squared, found.points, found.squaredDistances_m2,
                                 found.indices);
            expectNearest<D>(surfaces, p_map, found, n);
            map.nn_radius_search(query, squared, found.points, found.squaredDistances_m2,
                                 found.indices, 3);
            expectNearest<D>(surfaces, p_map, found, std::min<std::size_t>(n, 3));
        }
    }
}

TEST(NearestNeighbours, AreThoseOfBruteForceInSpace) {
    expectExactness<3>(lit_room::map());
}

TEST(NearestNeighbours, AreThoseOfBruteForceInThePlane) {
    expectExactness<2>(laser_room::map());
}

template <int D>
void expectNone(const CHGMMOccupancyMap& map, const QueryPoint<D>& query) {
    QueryPoint<D> point;
    float squared = -1;
    std::uint64_t index = 12345;
    EXPECT_FALSE(map.nn_single_search(query, point, squared, index));
    EXPECT_EQ(squared, -1);
    EXPECT_EQ(index, 12345U);
    Neighbours<D> found;
    for (auto* const search : {"multiple", "radius"}) {
        found.points.resize(3);
        found.squaredDistances_m2.resize(3);
        found.indices.resize(3);
        if (std::string(search) == "multiple")
            map.nn_multiple_search(query, 2, found.points, found.squaredDistances_m2,
                                   found.indices);
        else
            map.nn_radius_search(query, kInfinity, found.points, found.squaredDistances_m2,
                                 found.indices);
        EXPECT_TRUE(found.points.empty() && found.squaredDistances_m2.empty() &&
                    found.indices.empty())
            << search;
    }
}

TEST(NearestNeighbours, AreNoneOfNothing) {
    const CHGMMOccupancyMap empty;
    EXPECT_EQ(empty.nn_index_count(), 0U);
    empty.nn_prepare_for_2d_queries();
    empty.nn_prepare_for_3d_queries();
    expectNone<2>(empty, {0, 0});
    expectNone<3>(empty, {0, 0, 0});
    EXPECT_EQ(empty.boundingBox().min, mrpt::math::TPoint3Df(0, 0, 0));
    EXPECT_EQ(empty.boundingBox().max, mrpt::math::TPoint3Df(0, 0, 0));

    const CHGMMOccupancyMap map = lit_room::map();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expectNone<2>(map, {0, nan});
    expectNone<3>(map, {kInfinity, 0, 0});
    Neighbours<3> found;
    for (const float squared : {-1.F, nan}) {
        map.nn_radius_search({100, -50, 4}, squared, found.points,
                             found.squaredDistances_m2, found.indices);
        EXPECT_TRUE(found.points.empty()) << squared;
    }
}

TEST(NearestNeighbours, FollowTheMap) {
    CHGMMOccupancyMap map = laser_room::map();
    mrpt::math::TPoint3Df before, after;
    float squared = 0;
    std::uint64_t index = 0;
    ASSERT_TRUE(map.nn_single_search({101, -52, 4}, before, squared, index));
    const auto small = map.boundingBox();
    map.insertObservation(*lit_room::scan({0, 0, 0}, 3),
                          CPose3D(lit_room::kMiddle_map.x(), lit_room::kMiddle_map.y(),
                                  lit_room::kMiddle_map.z(), 0, 0, 0));
    ASSERT_TRUE(map.nn_single_search({101, -52, 4}, after, squared, index));
    EXPECT_LT(squared, 2 * 2);
    EXPECT_LT(small.max.x, 50);
    EXPECT_GT(map.boundingBox().max.x, 100);
    EXPECT_EQ(map.boundingBox().min.x, small.min.x);
    map.clear();
    EXPECT_FALSE(map.nn_single_search({101, -52, 4}, after, squared, index));
    EXPECT_EQ(map.boundingBox().max, mrpt::math::TPoint3Df(0, 0, 0));
}

TEST(BoundingBox, IsAroundTheSurfacesWithTheirThickness) {
    const CHGMMOccupancyMap map = lit_room::map();
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
    for (const auto& surface : surfacesOf<3>(map.model())) {
        low = low.cwiseMin(surface.mean_map - surface.halfExtent());
        high = high.cwiseMax(surface.mean_map + surface.halfExtent());
    }
    const auto box = map.boundingBox();
    for (int d = 0; d < 3; ++d) {
        EXPECT_NEAR(box.min[std::size_t(d)], low[d], 1e-4);
        EXPECT_NEAR(box.max[std::size_t(d)], high[d], 1e-4);
        const double wall = lit_room::kMiddle_map[d] + lit_room::kHalf_m[d];
        EXPECT_GT(box.max[std::size_t(d)], wall);
        EXPECT_LT(box.max[std::size_t(d)], wall + 1);
    }
    const auto other = box.intersection({{100, -53, 3}, {200, -52, 4}});
    ASSERT_TRUE(other);
    EXPECT_EQ(other->max.x, box.max.x);
}

}  // namespace
