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

BoxCells::Box randomBox(std::mt19937_64& engine) {
    BoxCells::Box box;
    const double size = std::exp(uniform(engine, std::log(1e-3), std::log(30.0)));
    for (int d = 0; d < 3; ++d) {
        box.centre[d] = static_cast<float>(uniform(engine, -20, 20));
        box.halfExtent[d] = static_cast<float>(size * uniform(engine, 0, 1));
    }
    return box;
}

bool holds(const BoxCells::Box& box, const Point& p) {
    for (int d = 0; d < 3; ++d)
        if (!(std::abs(p[d] - box.centre[d]) <= box.halfExtent[d])) return false;
    return true;
}

template <typename Index>
std::vector<std::uint32_t> candidates(const Index& index, const Point& p) {
    std::vector<std::uint32_t> found;
    index.visitCandidates(p[0], p[1], p[2], [&](std::uint32_t i) { found.push_back(i); });
    return found;
}

/// A plain list under the same operations.
template <int kBlockShift>
struct Pair {
    BoxIndex<kBlockShift> index;
    std::vector<BoxCells::Box> boxes;

    void update(std::uint32_t i, const BoxCells::Box& box) {
        if (i == boxes.size()) boxes.emplace_back();
        index.update(i, box, boxes[i].centre);
        boxes[i] = box;
    }
    void removeSwap(std::uint32_t i) {
        index.truncate(boxes.size() - 1,
                       [this](std::uint32_t k) { return boxes[k].centre; });
        const BoxCells::Box last = boxes.back();
        boxes.pop_back();
        if (i < boxes.size()) update(i, last);
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

template <int kBlockShift>
Pair<kBlockShift> filled(std::size_t n, std::mt19937_64& engine) {
    Pair<kBlockShift> pair;
    for (std::uint32_t i = 0; i < n; ++i) pair.update(i, randomBox(engine));
    return pair;
}

TEST(BoxIndex, FindsEveryBoxThatHoldsAPoint) {
    std::mt19937_64 engine(1);
    filled<0>(2000, engine).expectAgreement(engine, 500);
    filled<3>(2000, engine).expectAgreement(engine, 500);
}

// Blocks are a matter of memory: cells, and the order in them, are the same.
TEST(BoxIndex, BlocksOfAnySizeFindTheSameInTheSameOrder) {
    std::mt19937_64 engine(8);
    BoxIndex<0> single;
    BoxIndex<3> large;
    for (int i = 0; i < 1000; ++i) {
        const BoxCells::Box box = randomBox(engine);
        single.add(box);
        large.add(box);
    }
    for (int q = 0; q < 1000; ++q) {
        Point p{};
        for (float& v : p) v = static_cast<float>(uniform(engine, -21, 21));
        ASSERT_EQ(candidates(single, p), candidates(large, p));
    }
}

TEST(BoxIndex, PointsTogetherFindWhatEachFindsAlone) {
    std::mt19937_64 engine(7);
    BoxIndex<3> index;
    for (int i = 0; i < 500; ++i) index.add(randomBox(engine));
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

template <int kBlockShift>
void followUpdatesAndRemovals() {
    std::mt19937_64 engine(2);
    Pair<kBlockShift> pair = filled<kBlockShift>(500, engine);
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

TEST(BoxIndex, FollowsUpdatesAndRemovals) {
    followUpdatesAndRemovals<0>();
    followUpdatesAndRemovals<3>();
}

TEST(BoxIndex, RefusesAGap) {
    BoxIndex<3> index;
    EXPECT_THROW(index.update(1, {}, {}), std::out_of_range);
    EXPECT_EQ(index.size(), 0U);
}

TEST(BoxIndex, RefusesACentreThatWasElsewhere) {
    BoxIndex<3> index;
    index.add({{1, 2, 3}, {.1F, .1F, .1F}});
    EXPECT_THROW(index.update(0, {{0, 0, 0}, {.1F, .1F, .1F}}, {9, 9, 9}),
                 std::logic_error);
}

/// Whether start + s direction, s in [0, length], meets the box.
bool meets(const BoxCells::Box& box, const Eigen::Vector3f& start, const Eigen::Vector3f& u,
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
    const Pair<3> pair = filled<3>(1500, engine);
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
            BoxCells::Box inner = pair.boxes[i];
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
    const Pair<3> pair = filled<3>(100, engine);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const float v : {nan, inf, -inf, 1e30F, -1e30F})
        for (const Point& p : {Point{v, 0, 0}, Point{v, v, v}})
            for (const std::uint32_t i : candidates(pair.index, p)) {
                ASSERT_LT(i, pair.boxes.size());
                EXPECT_FALSE(holds(pair.boxes[i], p));
            }
    EXPECT_TRUE(candidates(pair.index, {1e6F, 1e6F, 1e6F}).empty());
    EXPECT_TRUE(candidates(BoxIndex<3>(), {0, 0, 0}).empty());
}

}  // namespace
}  // namespace hgmm
