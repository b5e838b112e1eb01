#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "hgmm/gaussian.h"
#include "hgmm/map.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using Row = std::array<float, 14>;  // all that a component is: its Gaussian and its view

/// Components in the order of their bits; those that are in a box, or those that are not.
std::vector<Row> sortedComponents(const Map& map, const Eigen::AlignedBox3d& box,
                                  bool inside) {
    const Mixture<3>& m = map.mixture();
    std::vector<Row> rows;
    for (std::size_t i = 0; i < m.size(); ++i) {
        const Eigen::Vector3d mean(m.mean[0][i], m.mean[1][i], m.mean[2][i]);
        if (box.contains(mean + map.origin()) != inside) continue;
        const ViewDirection view = map.viewDirections()[i];
        Row row{};
        std::size_t k = 0;
        row[k++] = m.support[i];
        for (const auto& axis : m.mean) row[k++] = axis[i];
        for (const auto& entry : m.covariance) row[k++] = entry[i];
        for (int d = 0; d < 3; ++d) row[k++] = static_cast<float>(view.direction[d]);
        row[k] = static_cast<float>(view.range_m);
        rows.push_back(row);
    }
    std::sort(rows.begin(), rows.end());
    return rows;
}

/// Whether a point is in the ellipsoid of a component.
bool isReached(const Eigen::Vector3d& point, const Mixture<3>& mixture) {
    for (std::size_t i = 0; i < mixture.size(); ++i)
        if (WhitenedGaussian<3>(mixture[i]).squaredMahalanobis(point.data()) <
            kReachSigmas * kReachSigmas)
            return true;
    return false;
}

Map scannedRoom(const Eigen::Vector3d& place) {
    Map map;
    for (int i = 0; i < 3; ++i) {
        Scan scan = testing::RoomScanner().scan(
            testing::poseAt(0.4 * i - 0.4, 0.2 * i, 1.2, 0.9 * i), 5 + i);
        scan.T_map_sensor.t += place;
        map.insert(scan);
    }
    return map;
}

TEST(Forget, TakesWhatIsInTheBoxAndNothingElse) {
    const Eigen::Vector3d place(700, -300, 20);
    Map map = scannedRoom(place);
    const Map before = map;
    const Mixture<3>& m = before.mixture();
    // One half of the room.
    const Eigen::AlignedBox3d box(place - Eigen::Vector3d(50, 50, 50),
                                  place + Eigen::Vector3d(0, 50, 50));
    const std::size_t inside = sortedComponents(before, box, true).size();
    ASSERT_GT(inside, 1U);
    ASSERT_LT(inside, m.size());
    EXPECT_EQ(map.forget(box), inside);
    EXPECT_EQ(map.mixture().size(), m.size() - inside);
    EXPECT_TRUE(sortedComponents(map, box, true).empty());
    EXPECT_EQ(sortedComponents(map, box, false), sortedComponents(before, box, false));
    int occupied = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
        const Eigen::Vector3d mean_local(m.mean[0][i], m.mean[1][i], m.mean[2][i]);
        const Eigen::Vector3d mean = before.origin() + mean_local;
        // Components that stay may reach into the box.
        if (!box.contains(mean) || isReached(mean_local, map.mixture())) continue;
        occupied += before.occupancy(mean).occupied > 0.5 ? 1 : 0;
        EXPECT_LT(map.occupancy(mean).occupied, 0.5) << (mean - place).transpose();
    }
    EXPECT_GT(occupied, 20);
    EXPECT_EQ(map.origin(), before.origin());
    EXPECT_EQ(map.forget(box), 0U);
}

/// Indices and levels that were made before follow.
TEST(Forget, AnswersAreThoseOfAFreshCopy) {
    Map map = scannedRoom({0, 0, 0});
    const Eigen::Vector3d probe(0.3, 0.2, 1.1);
    for (std::size_t level = 0; level < map.levelCount(); ++level)
        map.occupancy(probe, level);
    const Eigen::AlignedBox3d half(Eigen::Vector3d(0, -50, -50),
                                   Eigen::Vector3d(50, 50, 50));
    ASSERT_GT(map.forget(half), 0U);
    const Map fresh = map;
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        EXPECT_EQ(map.mixture(level), fresh.mixture(level));
        for (double x = -3; x <= 3; x += 0.25)
            EXPECT_EQ(map.occupancy({x, 0.4, 1.0}, level).occupied,
                      fresh.occupancy({x, 0.4, 1.0}, level).occupied);
    }
}

/// The local frame stays, for free space is in it.
TEST(Forget, AMapThatForgotAllGoesOnWhereItWas) {
    Map map = scannedRoom({40, 0, 0});
    const Eigen::Vector3d origin = map.origin();
    const std::size_t all = map.mixture().size();
    const Eigen::AlignedBox3d everywhere(Eigen::Vector3d::Constant(-1e3),
                                         Eigen::Vector3d::Constant(1e3));
    EXPECT_EQ(map.forget(everywhere), all);
    EXPECT_TRUE(map.empty());
    Scan scan = testing::RoomScanner().scan(testing::poseAt(0, 0, 1.2), 5);
    scan.T_map_sensor.t.x() += 900;
    map.insert(scan);
    EXPECT_FALSE(map.empty());
    EXPECT_EQ(map.origin(), origin);
}

TEST(Forget, ABadBoxIsRefused) {
    Map map = scannedRoom({0, 0, 0});
    const Map before = map;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d low(-1, -1, -1), high(1, 1, 1);
    for (const auto& [a, b] :
         std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>{{high, low},
                                                                  {low, {1, -2, 1}},
                                                                  {{nan, -1, -1}, high},
                                                                  {low, {1, 1, nan}},
                                                                  {low, {1, inf, 1}}})
        EXPECT_THROW(map.forget({a, b}), std::invalid_argument);
    EXPECT_THROW(map.forget(Eigen::AlignedBox3d()), std::invalid_argument);
    EXPECT_EQ(map, before);
    EXPECT_EQ(Map().forget({low, high}), 0U);
}

}  // namespace
}  // namespace hgmm
