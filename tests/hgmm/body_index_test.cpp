#include "index/body_index.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::uniform;
using Point = std::array<float, 3>;

std::vector<std::uint32_t> bodiesAt(const BodyIndex& index, const Point& p) {
    std::vector<std::uint32_t> found;
    index.visitCandidates(p[0], p[1], p[2], [&](std::uint32_t i) { found.push_back(i); });
    return found;
}

struct Ball {
    Point centre{};
    float radius = 0;

    float distanceTo(const float* p) const {
        return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
    }
    BoxCells::Box box() const { return {centre, {radius, radius, radius}}; }
};

auto touchedBy(const Ball& ball) {
    return [&ball](const float* cube, float halfEdge) {
        return ball.distanceTo(cube) <= ball.radius + 1.7321F * halfEdge;
    };
}

// As those of a map do, whose index must become what it would be if made anew.
TEST(BodyIndex, BodiesThatMoveALittleAreWhereTheyAre) {
    std::mt19937_64 engine(4);
    BodyIndex index(BodyIndex::Cells{3, -2}), anew(BodyIndex::Cells{3, -2});
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
        const std::vector<std::uint32_t> now = bodiesAt(index, p);
        ASSERT_EQ(now, bodiesAt(anew, p)) << "and in the same order";
        found += now.size();
    }
    EXPECT_GT(found, 5000U);
}

TEST(BodyIndex, BodiesAreFoundInTheFinerCellsThatTheyTouchOnly) {
    std::mt19937_64 engine(3);
    BodyIndex index(BodyIndex::Cells{3, -2}), ofBoxes(BodyIndex::Cells{3, -2});
    const auto always = [](const float*, float) { return true; };
    std::vector<Ball> balls(200);
    const auto place = [&](std::uint32_t i) {
        const Ball before = balls[i];
        for (float& v : balls[i].centre) v = static_cast<float>(uniform(engine, -5, 5));
        balls[i].radius = static_cast<float>(uniform(engine, 0.01, 3));
        index.update(i, balls[i].box(), touchedBy(balls[i]), touchedBy(before));
        ofBoxes.update(i, balls[i].box(), always, always);
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
        ofBoxes.update(i, balls[i].box(), always, always);
    }
    std::size_t visited = 0, visitedOfBoxes = 0;
    for (int q = 0; q < 2000; ++q) {
        Point p{};
        for (float& v : p) v = static_cast<float>(uniform(engine, -6, 6));
        const auto found = bodiesAt(index, p);
        const std::set<std::uint32_t> unique(found.begin(), found.end());
        EXPECT_EQ(unique.size(), found.size()) << "visited twice";
        for (std::uint32_t i = 0; i < balls.size(); ++i)
            if (balls[i].distanceTo(p.data()) <= balls[i].radius) {
                EXPECT_EQ(unique.count(i), 1U);
            }
        visited += found.size();
        visitedOfBoxes += bodiesAt(ofBoxes, p).size();
    }
    EXPECT_LT(double(visited), 0.8 * double(visitedOfBoxes));
}

}  // namespace
}  // namespace hgmm
