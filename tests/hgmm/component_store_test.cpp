#include "map/component_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

#include "scenes.h"

namespace hgmm {
namespace {

using testing::Box;
using testing::RoomScanner;

Gaussian<3> component(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Gaussian<3> g;
    g.support = 1 + double(random() % 100);
    g.mean << normal(random), normal(random), normal(random);
    g.covariance = (0.1 + double(random() % 10)) * Eigen::Matrix3d::Identity();
    return g;
}

/// What an index does: it drops rows from `size` on and enters the updated ones anew.
void follow(const Changes& changes, const ComponentStore& store,
            std::vector<float>& supports) {
    if (supports.size() > changes.size) supports.resize(changes.size);
    for (const std::uint32_t i : changes.updated) {
        ASSERT_LE(i, supports.size()) << "rows are entered in order, without gaps";
        if (i == supports.size()) supports.emplace_back();
        supports[i] = store.surfaces().support[i];
    }
}

TEST(ComponentStore, WhoFollowsItsChangesHoldsItsRows) {
    std::mt19937_64 random(1);
    ComponentStore store;
    std::vector<float> followed;
    for (int round = 0; round < 300; ++round) {
        for (unsigned k = random() % 20; k > 0; --k) {
            const auto i =
                static_cast<std::uint32_t>(store.empty() ? 0 : random() % store.size());
            switch (store.empty() ? 0 : random() % 4) {
                case 0: {
                    const std::size_t before = store.size();
                    EXPECT_EQ(store.add(component(random), {}), before);
                    break;
                }
                case 1:
                    store.set(i, component(random), {});
                    break;
                case 2:
                    store.setSupport(i, 0.5F + float(random() % 9));
                    break;
                default:
                    store.remove(i);
            }
        }
        follow(store.takeChanges(), store, followed);
        ASSERT_EQ(followed, store.surfaces().support);
        ASSERT_EQ(store.viewDirections().size(), store.size());
    }
    EXPECT_TRUE(store.takeChanges().updated.empty()) << "nothing is told twice";
}

/// The bytes of all that a map answers, from its indices and caches.
std::vector<unsigned char> answersOf(const Map& map, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> x(-5, 5), y(-4, 4), z(-0.5, 3);
    std::vector<unsigned char> bytes;
    const auto put = [&bytes](const auto& value) {
        unsigned char raw[sizeof(value)];
        std::memcpy(raw, &value, sizeof(value));
        bytes.insert(bytes.end(), raw, raw + sizeof(value));
    };
    const auto putArray = [&](const std::vector<float>& array) {
        for (const float v : array) put(v);
    };
    for (int q = 0; q < 200; ++q) {
        const Eigen::Vector3d p(x(random), y(random), z(random));
        const Eigen::Vector3d to(x(random), y(random), z(random));
        const std::size_t level = q % 4 == 0 ? map.levelCount() - 1 : 0;
        const Occupancy o = map.occupancy(p, level);
        for (const float v : {o.occupied, o.free, o.unknown, o.alongRay_m, o.variance_m2})
            put(v);
        for (const double v : map.occupancyGradient(p)) put(v);
        put(map.logDensity(p));
        const auto hit = map.castRay(p, to - p);
        put(hit ? hit->range_m : -1.0);
        const ModalityEstimate grey = map.modality("intensity", p);
        put(grey.mean), put(grey.variance);
    }
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        putArray(map.mixture(level).support);
        for (const auto& axis : map.mixture(level).mean) putArray(axis);
        putArray(map.freeMixture(level).support);
        map.viewDirections(level).forEachArray(putArray);
    }
    return bytes;
}

/// A room in which a box appears and goes.
Scan someScan(std::mt19937_64& random) {
    const double at = 1.5 + 0.5 * double(random() % 3);
    const Box box{Eigen::Vector3d(at, -0.4, 0.0), Eigen::Vector3d(at + 0.5, 0.4, 1.5)};
    RoomScanner scanner = random() % 2 == 0 ? testing::emptyRoom() : testing::roomWith(box);
    scanner.azimuths = 90;
    scanner.elevations = 12;
    const auto seed = random();
    Scan scan = scanner.scan(testing::walk(static_cast<int>(random() % 20), 0.8), seed);
    scan.channels.push_back({"intensity", {}});
    for (std::size_t i = 0; i < scan.size(); ++i)
        scan.channels[0].values.push_back(std::fmod(std::abs(scan.y[i] + scan.z[i]), 1.F));
    return scan;
}

MapParams withIntensity() {
    MapParams params;
    params.modalities = {"intensity"};
    return params;
}

void change(Map& map, std::mt19937_64& random) {
    switch (random() % 12) {
        case 0:
            map.clear();
            break;
        case 1: {
            MapParams params = map.params();
            params.occupancy.knownSigmas = 2.5 + 0.1 * double(random() % 10);
            params.hierarchy.levels = 2 + static_cast<int>(random() % 4);
            map.setParams(params);
            break;
        }
        case 2: {
            Map other(withIntensity());
            for (int k = 0; k < 2; ++k) other.insert(someScan(random));
            map.merge(other, testing::shaken({}, 0.02, 0.002, random()));
            break;
        }
        case 3: {
            Map moved = std::move(map);
            map = random() % 2 == 0 ? moved : std::move(moved);
            break;
        }
        default:
            map.insert(someScan(random));
    }
}

// Everything that is computed from the model follows it through any change: a copy, which
// computes it anew, says the same, bit for bit, and goes on alike.
TEST(QueryCache, IsThatOfAFreshCopyAfterAnyChanges) {
    std::size_t removed = 0;
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        std::mt19937_64 random(seed);
        Map map(withIntensity());
        for (int step = 0; step < 25; ++step) {
            answersOf(map, seed);  // so that there are caches, which must follow
            change(map, random);
            const Map fresh = map;
            ASSERT_EQ(answersOf(map, step), answersOf(fresh, step))
                << "seed " << seed << ", step " << step;
            Map goesOn = fresh;
            const Scan scan = someScan(random);
            removed += map.insert(scan).componentsRemoved;
            goesOn.insert(scan);
            ASSERT_TRUE(map == goesOn) << "seed " << seed << ", step " << step;
        }
    }
    EXPECT_GT(removed, 20U) << "else removals were not tried";
}

TEST(Map, IsEmptyAndUsableWhenMovedFrom) {
    std::mt19937_64 random(1);
    Map map;
    map.insert(someScan(random));
    Map taken = std::move(map);
    EXPECT_FALSE(taken.empty());
    EXPECT_TRUE(map.empty());  // NOLINT: what a moved-from map is, is what this is about
    EXPECT_GT(map.liveBytes(), 0U);
    EXPECT_EQ(map.mixture(1).size(), 0U);
    map.merge(taken);
    EXPECT_EQ(map.mixture().size(), taken.mixture().size());
    Map other;
    other = std::move(taken);
    EXPECT_TRUE(taken.empty());  // NOLINT
    taken.insert(someScan(random));
    EXPECT_FALSE(taken.empty());
    Map& same = other;
    other = std::move(same);
    EXPECT_FALSE(other.empty());
}

}  // namespace
}  // namespace hgmm
