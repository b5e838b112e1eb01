#include "index/box_index.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::normal;
using test::uniform;
using Point = std::array<float, 3>;

BoxIndex::Box randomBox(std::mt19937_64& engine) {
    BoxIndex::Box box;
    const double size = std::exp(uniform(engine, std::log(1e-3), std::log(30.0)));
    for (int d = 0; d < 3; ++d) {
        box.centre[d] = static_cast<float>(uniform(engine, -20, 20));
        box.halfExtent[d] = static_cast<float>(size * uniform(engine, 0, 1));
    }
    return box;
}

bool holds(const BoxIndex::Box& box, const Point& p) {
    for (int d = 0; d < 3; ++d)
        if (!(std::abs(p[d] - box.centre[d]) <= box.halfExtent[d])) return false;
    return true;
}

std::vector<std::uint32_t> candidates(const BoxIndex& index, const Point& p) {
    std::vector<std::uint32_t> found;
    index.visitCandidates(p[0], p[1], p[2], [&](std::uint32_t i) { found.push_back(i); });
    return found;
}

/// A plain list under the same operations.
struct Pair {
    BoxIndex index;
    std::vector<BoxIndex::Box> boxes;

    void update(std::uint32_t i, const BoxIndex::Box& box) {
        index.update(i, box);
        if (i == boxes.size()) boxes.emplace_back();
        boxes[i] = box;
    }
    void removeSwap(std::uint32_t i) {
        boxes[i] = boxes.back();
        boxes.pop_back();
        index.truncate(boxes.size());
        if (i < boxes.size()) index.update(i, boxes[i]);
    }
    void expectAgreement(std::mt19937_64& engine, int queries) const {
        ASSERT_EQ(index.size(), boxes.size());
        for (int q = 0; q < queries; ++q) {
            Point p{};
            const auto& near = boxes[engine() % boxes.size()];
            for (int d = 0; d < 3; ++d)
                p[d] = near.centre[d] +
                       static_cast<float>(uniform(engine, -1.5, 1.5)) * near.halfExtent[d];
            const auto found = candidates(index, p);
            const std::set<std::uint32_t> unique(found.begin(), found.end());
            EXPECT_EQ(unique.size(), found.size()) << "visited twice";
            for (std::uint32_t i = 0; i < boxes.size(); ++i)
                if (holds(boxes[i], p)) {
                    EXPECT_EQ(unique.count(i), 1U);
                }
            for (const std::uint32_t i : unique) EXPECT_LT(i, boxes.size());
        }
    }
};

Pair filled(std::size_t n, std::mt19937_64& engine) {
    Pair pair;
    for (std::uint32_t i = 0; i < n; ++i) pair.update(i, randomBox(engine));
    return pair;
}

TEST(BoxIndex, FindsEveryBoxThatHoldsAPoint) {
    std::mt19937_64 engine(1);
    filled(2000, engine).expectAgreement(engine, 500);
}

TEST(BoxIndex, PointsTogetherFindWhatEachFindsAlone) {
    std::mt19937_64 engine(7);
    BoxIndex index;
    for (std::uint32_t i = 0; i < 500; ++i) index.update(i, randomBox(engine));
    std::vector<float> x, y, z;
    for (int k = 0; k < 700; ++k) {
        // Clusters, so that cells hold several, and points far off.
        const double cluster = k % 70 == 0 ? 1e7 : double(k % 7) * 3 - 10;
        x.push_back(static_cast<float>(cluster + 0.2 * normal(engine)));
        y.push_back(static_cast<float>(2 * normal(engine)));
        z.push_back(static_cast<float>(0.1 * normal(engine)));
    }
    const CellOrder order =
        orderedByCells(x.data(), y.data(), z.data(), x.size(), index.smallestOctave());
    ASSERT_EQ(order.size(), x.size());
    std::vector<std::vector<std::uint32_t>> together(x.size());
    std::size_t longest = 0;
    const auto take = [&](std::uint32_t i, std::size_t first, std::size_t last) {
        longest = std::max(longest, last - first);
        for (std::size_t k = first; k < last; ++k) together[order.index[k]].push_back(i);
    };
    // In two parts, as threads ask.
    index.visitCandidates(order, 0, 300, take);
    index.visitCandidates(order, 300, x.size(), take);
    for (std::size_t k = 0; k < x.size(); ++k)
        EXPECT_EQ(together[k], candidates(index, {x[k], y[k], z[k]})) << k;
    EXPECT_GT(longest, 10U);
}

TEST(BoxIndex, FollowsUpdatesAndRemovals) {
    std::mt19937_64 engine(2);
    Pair pair = filled(500, engine);
    for (int step = 0; step < 20; ++step) {
        for (int k = 0; k < 50; ++k)
            pair.update(static_cast<std::uint32_t>(engine() % pair.boxes.size()),
                        randomBox(engine));
        for (int k = 0; k < 20; ++k)
            pair.removeSwap(static_cast<std::uint32_t>(engine() % pair.boxes.size()));
        pair.update(static_cast<std::uint32_t>(pair.boxes.size()), randomBox(engine));
        pair.expectAgreement(engine, 30);
    }
    while (!pair.boxes.empty())
        pair.removeSwap(static_cast<std::uint32_t>(engine() % pair.boxes.size()));
    EXPECT_EQ(pair.index.size(), 0U);
    EXPECT_TRUE(candidates(pair.index, {0, 0, 0}).empty());
}

struct Ball {
    Point centre{};
    float radius = 0;

    float distanceTo(const float* p) const {
        return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
    }
    BoxIndex::Box box() const { return {centre, {radius, radius, radius}}; }
};

auto touchedBy(const Ball& ball) {
    return [&ball](const float* cube, float halfEdge) {
        return ball.distanceTo(cube) <= ball.radius + 1.7321F * halfEdge;
    };
}

// As those of a map do, whose index must become what it would be if made anew.
TEST(BoxIndex, BodiesThatMoveALittleAreWhereTheyAre) {
    std::mt19937_64 engine(4);
    BoxIndex index(BoxIndex::Cells{3, -2}), anew(BoxIndex::Cells{3, -2});
    std::vector<Ball> balls(100);
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
        for (float& v : balls[i].centre) v = static_cast<float>(uniform(engine, -2, 2));
        balls[i].radius = static_cast<float>(uniform(engine, 0.5, 0.9));
        index.update(i, balls[i].box(), touchedBy(balls[i]), touchedBy(balls[i]));
    }
    for (int k = 0; k < 1000; ++k) {
        const auto i = static_cast<std::uint32_t>(engine() % balls.size());
        const Ball before = balls[i];
        for (float& v : balls[i].centre)
            v += static_cast<float>(uniform(engine, -.05, .05));
        index.update(i, balls[i].box(), touchedBy(balls[i]), touchedBy(before));
    }
    for (std::uint32_t i = 0; i < balls.size(); ++i)
        anew.update(i, balls[i].box(), touchedBy(balls[i]), touchedBy(balls[i]));
    std::size_t found = 0;
    for (int q = 0; q < 5000; ++q) {
        Point p{};
        for (float& v : p) v = static_cast<float>(uniform(engine, -3, 3));
        const std::vector<std::uint32_t> now = candidates(index, p);
        ASSERT_EQ(now, candidates(anew, p)) << "and in the same order";
        found += now.size();
    }
    EXPECT_GT(found, 5000U);
}

TEST(BoxIndex, BodiesAreFoundInTheFinerCellsThatTheyTouchOnly) {
    std::mt19937_64 engine(3);
    BoxIndex index(BoxIndex::Cells{3, -2}), ofBoxes(BoxIndex::Cells{3, -2});
    std::vector<Ball> balls(200);
    const auto place = [&](std::uint32_t i) {
        const Ball before = balls[i];
        for (float& v : balls[i].centre) v = static_cast<float>(uniform(engine, -5, 5));
        balls[i].radius = static_cast<float>(uniform(engine, 0.01, 3));
        index.update(i, balls[i].box(), touchedBy(balls[i]), touchedBy(before));
        ofBoxes.update(i, balls[i].box());
    };
    for (std::uint32_t i = 0; i < balls.size(); ++i) place(i);
    for (int k = 0; k < 100; ++k)
        place(static_cast<std::uint32_t>(engine() % balls.size()));
    for (int k = 0; k < 50; ++k) {
        const auto i = static_cast<std::uint32_t>(engine() % balls.size());
        const Ball before = balls[i], last = balls.back();
        balls.pop_back();
        index.truncate(balls.size());
        ofBoxes.truncate(balls.size());
        if (i == balls.size()) continue;
        balls[i] = last;
        index.update(i, balls[i].box(), touchedBy(balls[i]), touchedBy(before));
        ofBoxes.update(i, balls[i].box());
    }
    std::size_t visited = 0, visitedOfBoxes = 0;
    for (int q = 0; q < 2000; ++q) {
        Point p{};
        for (float& v : p) v = static_cast<float>(uniform(engine, -6, 6));
        const auto found = candidates(index, p);
        const std::set<std::uint32_t> unique(found.begin(), found.end());
        EXPECT_EQ(unique.size(), found.size()) << "visited twice";
        for (std::uint32_t i = 0; i < balls.size(); ++i)
            if (balls[i].distanceTo(p.data()) <= balls[i].radius) {
                EXPECT_EQ(unique.count(i), 1U);
            }
        visited += found.size();
        visitedOfBoxes += candidates(ofBoxes, p).size();
    }
    EXPECT_LT(double(visited), 0.8 * double(visitedOfBoxes));
}

TEST(BoxIndex, RefusesAGap) {
    BoxIndex index;
    EXPECT_THROW(index.update(1, {}), std::out_of_range);
    EXPECT_EQ(index.size(), 0U);
}

/// Whether start + s direction, s in [0, length], meets the box.
bool meets(const BoxIndex::Box& box, const Eigen::Vector3f& start, const Eigen::Vector3f& u,
           float length) {
    double enter = 0, leave = length;
    for (int d = 0; d < 3; ++d) {
        const double low = double(box.centre[d]) - box.halfExtent[d] - start[d];
        const double high = double(box.centre[d]) + box.halfExtent[d] - start[d];
        if (u[d] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        enter = std::max(enter, std::min(low / u[d], high / u[d]));
        leave = std::min(leave, std::max(low / u[d], high / u[d]));
    }
    return enter <= leave;
}

TEST(BoxIndex, RaysMeetEveryBoxOnTheirWayInAllOctaves) {
    std::mt19937_64 engine(3);
    const Pair pair = filled(1500, engine);
    std::size_t met = 0;
    for (int q = 0; q < 300; ++q) {
        Eigen::Vector3f start, u;
        for (int d = 0; d < 3; ++d) {
            start[d] = static_cast<float>(uniform(engine, -25, 25));
            u[d] = static_cast<float>(normal(engine));
        }
        if (q % 5 == 0) u = Eigen::Vector3f::Unit(q / 5 % 3) * (q % 2 == 0 ? 1.F : -1.F);
        u.normalize();
        const auto length = static_cast<float>(uniform(engine, 0.01, 60));
        std::set<std::uint32_t> found;
        pair.index.visitAlongRay(start.data(), u.data(), length,
                                 [&](std::uint32_t i) { found.insert(i); });
        for (std::uint32_t i = 0; i < pair.boxes.size(); ++i) {
            // Rays that only brush a box are rounding's to decide.
            BoxIndex::Box inner = pair.boxes[i];
            for (float& e : inner.halfExtent) e = std::max(0.F, e - 1e-4F);
            if (*std::min_element(inner.halfExtent.begin(), inner.halfExtent.end()) <= 0)
                continue;
            if (!meets(inner, start, u, length)) continue;
            ++met;
            EXPECT_EQ(found.count(i), 1U) << "ray " << q << " box " << i;
        }
    }
    EXPECT_GT(met, 1000U);
}

TEST(BoxIndex, FarAndInvalidQueriesEnd) {
    std::mt19937_64 engine(4);
    const Pair pair = filled(100, engine);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const float v : {nan, inf, -inf, 1e30F, -1e30F})
        for (const Point& p : {Point{v, 0, 0}, Point{v, v, v}})
            for (const std::uint32_t i : candidates(pair.index, p)) {
                ASSERT_LT(i, pair.boxes.size());
                EXPECT_FALSE(holds(pair.boxes[i], p));
            }
    EXPECT_TRUE(candidates(pair.index, {1e6F, 1e6F, 1e6F}).empty());
    EXPECT_TRUE(candidates(BoxIndex(), {0, 0, 0}).empty());
}

}  // namespace
}  // namespace hgmm
