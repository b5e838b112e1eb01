#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hgmm/evaluation/seen_cells.h"
#include "hgmm/evaluation/unseen_points.h"

using namespace hgmm::evaluation;
using Eigen::Vector3d;

namespace {

/// A fan of rays from (0.05, 0.05, 0.05) to a wall at x = 4.05, 2 m to either side and 1 m
/// up and down, closer than cells of 10 cm.
hgmm::Scan wallScan() {
    hgmm::Scan scan;
    scan.T_map_sensor.t << 0.05, 0.05, 0.05;
    for (int i = -50; i <= 50; ++i)
        for (int j = -25; j <= 25; ++j)
            scan.pushBack(4.F, 0.04F * static_cast<float>(i),
                          0.04F * static_cast<float>(j));
    return scan;
}

/// The same answer to all points.
OccupancyQuery always(const hgmm::Occupancy& answer) {
    return [answer](const Points& points_map) {
        return std::vector<hgmm::Occupancy>(points_map.size(), answer);
    };
}

hgmm::Occupancy answerOf(float occupied, float free, float unknown) {
    hgmm::Occupancy answer;
    answer.occupied = occupied;
    answer.free = free;
    answer.unknown = unknown;
    return answer;
}

}  // namespace

TEST(SeenCells, OneRayReachesTwoCellsToEachSide) {
    SeenCells cells(0.1);
    cells.addRay({0.05, 0.05, 0.05}, {0.95, 0.05, 0.05});  // cells 0 to 9 of a row
    EXPECT_EQ(cells.size(), 10U);
    for (int x = -5; x < 15; ++x)
        for (int y = -4; y < 5; ++y)
            for (int z = -4; z < 5; ++z) {
                const bool near =
                    x >= -2 && x <= 11 && std::abs(y) <= 2 && std::abs(z) <= 2;
                EXPECT_EQ(cells.isUnseen({0.1 * x + 0.05, 0.1 * y + 0.05, 0.1 * z + 0.05}),
                          !near)
                    << x << " " << y << " " << z;
            }
    EXPECT_TRUE(cells.isUnseen(Vector3d::Constant(std::nan(""))));
}

TEST(SeenCells, BlocksMeetAtTheOriginAndBeyond) {
    // A row through several blocks of cells, negative ones as well, there and back.
    for (const double turn : {1.0, -1.0}) {
        SeenCells cells(0.5);
        cells.addRay(turn * Vector3d(-20.25, 0.25, 0.25),
                     turn * Vector3d(20.25, 0.25, 0.25));
        EXPECT_EQ(cells.size(), 82U);
        for (double x = -20.25; x < 20.5; x += 0.5)
            ASSERT_FALSE(cells.isUnseen({x, turn * 0.25, turn * 0.25})) << x;
        EXPECT_TRUE(cells.isUnseen({turn * 21.75, turn * 0.25, turn * 0.25}));
    }
}

TEST(SeenCells, ClearedRaysCountAndBrokenPointsDoNot) {
    hgmm::Scan scan;
    scan.T_map_sensor.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    scan.pushBack(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    scan.clearedRays.push_back({{1, 0, 0}, 3.F});
    SeenCells cells(0.1);
    cells.add(scan);
    EXPECT_FALSE(cells.isUnseen({0, 2.9, 0})) << "the sensor looks along +y";
    EXPECT_TRUE(cells.isUnseen({0, 3.5, 0}));
    EXPECT_TRUE(cells.isUnseen({2.9, 0, 0}));
}

TEST(SeenCells, OneOfHitsSideBySideStandsForAllButNotForThoseApart) {
    hgmm::Scan scan;  // hits 1 cm apart over a metre, at 2 m, in cells of 10 cm
    for (int i = 0; i < 100; ++i) scan.pushBack(2.F, 0.01F * static_cast<float>(i), 0.F);
    SeenCells all(0.1), thinned(0.1);
    for (std::size_t i = 0; i < scan.size(); ++i)
        all.addRay({0, 0, 0}, {scan.x[i], scan.y[i], scan.z[i]});
    thinned.add(scan);
    EXPECT_LE(thinned.size(), all.size());
    EXPECT_GT(thinned.size(), all.size() * 19 / 20);
    for (double x = 0.05; x < 2.0; x += 0.1)
        for (double y = 0.0; y < 0.5 * x; y += 0.05)
            ASSERT_FALSE(thinned.isUnseen({x, y, 0})) << x << " " << y;
}

TEST(SeenCells, EdgeGoesByTheMedianRange) {
    hgmm::Scan scan;
    for (const float range : {1.F, 5.F, 7.F, 80.F, 90.F}) scan.pushBack(range, 0, 0);
    scan.pushBack(std::nanf(""), 0, 0);
    EXPECT_EQ(seenCellEdge_m(scan), 0.15);
    scan.x[2] = 5.5F;
    EXPECT_EQ(seenCellEdge_m(scan), 0.05);
}

TEST(Unseen, PointsBehindAWallAreUnseenAndThoseBeforeItAreNot) {
    SeenSpace seen(3);
    seen.add(wallScan(), 0);
    const UnseenPoints points = seen.draw();
    ASSERT_GT(points.behindHits_map.size(), 1000U);
    ASSERT_GT(points.free_map.size(), 1000U);
    const double nearest = 4.05 + 2 * points.edge_m;
    for (const Vector3d& p : points.behindHits_map) {
        ASSERT_GT(p.x(), nearest);
        ASSERT_LT(p.x(), 4.05 + 1.5 + 1e-9);
    }
    for (const Vector3d& p : points.free_map) ASSERT_LT(p.x(), 4.05 - 0.1);
    // The box around the hits is the wall itself, all of which was seen.
    EXPECT_TRUE(points.inBox_map.empty());

    // Another wall, 2 m farther and far aside, opens the box between.
    hgmm::Scan aside = wallScan();
    for (float& x : aside.x) x += 2.F;
    for (float& y : aside.y) y += 9.F;
    seen.add(aside, 1);
    const UnseenPoints more = seen.draw();
    ASSERT_GT(more.inBox_map.size(), 1000U);
    for (const Vector3d& p : more.inBox_map) {
        ASSERT_GT(p.x(), 4.05 - 1e-6);
        ASSERT_LT(p.x(), 6.05 + 1e-6);
        // The first wall's own two metres to either side are seen at its face only.
        if (std::abs(p.y() - 0.05) < 1.9) {
            ASSERT_GT(p.x(), nearest);
        }
    }
    EXPECT_EQ(seen.draw().inBox_map, more.inBox_map);
}

TEST(Unseen, CountsByHand) {
    UnseenPoints points;
    points.behindHits_map = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}};
    points.inBox_map = {{1, 1, 0}, {2, 1, 0}};
    points.free_map = {{1, 2, 0}, {2, 2, 0}, {3, 2, 0}, {4, 2, 0}, {5, 2, 0}};
    const OccupancyQuery query = [](const Points& points_map) {
        std::vector<hgmm::Occupancy> answers;
        for (const Vector3d& p : points_map)
            answers.push_back(p.x() > 3.5   ? answerOf(0.1F, 0.2F, 0.7F)
                              : p.x() > 2.5 ? answerOf(0.2F, 0.5F, 0.3F)
                              : p.x() > 1.5 ? answerOf(0.3F, 0.6F, 0.1F)
                                            : answerOf(0.6F, 0.4F, 0.0F));
        return answers;
    };
    const UnseenFigures f = evaluateUnseen(query, points);
    EXPECT_EQ(f.behindHits, 4U);
    EXPECT_EQ(f.inBox, 2U);
    EXPECT_EQ(f.free, 5U);
    EXPECT_DOUBLE_EQ(f.calledFreeBehindHits, 1.0 / 4);  // half is not more than half
    EXPECT_DOUBLE_EQ(f.calledFreeInBox, 1.0 / 2);
    EXPECT_DOUBLE_EQ(f.calledOccupied, 2.0 / 6);
    EXPECT_NEAR(f.meanUnknown, (0.0 + 0.1 + 0.3 + 0.7 + 0.0 + 0.1) / 6, 1e-6);
    EXPECT_DOUBLE_EQ(f.seenCalledUnknown, 2.0 / 5);
}

TEST(Unseen, ATimidMapIsSeenThrough) {
    SeenSpace seen(1);
    seen.add(wallScan(), 0);
    const UnseenPoints points = seen.draw();
    const UnseenFigures timid = evaluateUnseen(always(answerOf(0, 0, 1)), points);
    EXPECT_EQ(timid.calledFreeBehindHits, 0.0);
    EXPECT_EQ(timid.meanUnknown, 1.0);
    EXPECT_EQ(timid.seenCalledUnknown, 1.0);
    const UnseenFigures bold = evaluateUnseen(always(answerOf(0, 1, 0)), points);
    EXPECT_EQ(bold.calledFreeBehindHits, 1.0);
    EXPECT_EQ(bold.seenCalledUnknown, 0.0);
    const UnseenFigures none = evaluateUnseen(always(answerOf(0, 1, 0)), {});
    EXPECT_EQ(none.calledFreeBehindHits, 0.0);
    EXPECT_EQ(none.meanUnknown, 0.0);
}

TEST(Unseen, AnswersOfOtherMapsAreAllOrNothing) {
    const hgmm::Occupancy unknown = occupancyOfAnswer({0.5, true});
    EXPECT_EQ(unknown.unknown, 1.F);
    EXPECT_EQ(unknown.free, 0.F);
    const hgmm::Occupancy known = occupancyOfAnswer({0.25, false});
    EXPECT_EQ(known.unknown, 0.F);
    EXPECT_FLOAT_EQ(known.occupied, 0.25F);
    EXPECT_FLOAT_EQ(known.free, 0.75F);
}
