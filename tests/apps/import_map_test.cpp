#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <functional>
#include <memory>

#include "pcd_files.h"
#include "replay_map_fixture.h"

namespace {

enum State { unknown, free_, occupied };

/// A room of 3 x 2.4 x 1.6 m with a table and a post that nobody looked into.
State roomAt(double x, double y, double z) {
    constexpr double e = 0.1;
    if (x < 0 || y < 0 || z < 0 || x > 3 || y > 2.4 || z > 1.6) return unknown;
    if (x < e || y < e || z < e || x > 3 - e || y > 2.4 - e) return occupied;
    const double fromPost = std::max(std::abs(x - 2.2), std::abs(y - 1.6));
    if (fromPost < 0.3) return fromPost > 0.3 - e ? occupied : unknown;
    const bool isTable = x > 0.5 && x < 1.2 && y > 0.6 && y < 1.6 && z > 0.7 && z < 0.8;
    return isTable ? occupied : free_;
}

/// Calls visit(x, y, z) for the middles of the cells around the room, [m].
void forEachCell(const std::function<void(double, double, double)>& visit) {
    for (int z = -2; z < 18; ++z)
        for (int y = -2; y < 27; ++y)
            for (int x = -2; x < 33; ++x)
                visit((x + 0.5) * 0.1, (y + 0.5) * 0.1, (z + 0.5) * 0.1);
}

/// How many cells say the same, the opposite, and nothing any more or what they did not.
struct Counts {
    double known = 0, same = 0, opposite = 0, unknown = 0, unknownKept = 0;

    void add(State before, State after) {
        (before == State::unknown ? unknown : known) += 1;
        if (before == State::unknown)
            unknownKept += after == State::unknown ? 1 : 0;
        else if (before == after)
            same += 1;
        else if (after != State::unknown)
            opposite += 1;
    }
    void expectGood() const {
        EXPECT_GT(known, 0);
        EXPECT_GE(same, 0.98 * known);
        EXPECT_LE(opposite, 0.005 * known);
        EXPECT_GE(unknownKept, 0.95 * unknown);
    }
};

/// Imports maps that OctoMap and ROS' map_server would have written, and exports them
/// again.
class ImportMap : public ReplayFolder {
 protected:
    Outcome importMap(const std::string& input, const std::string& more = "") const {
        return run("hgmm-import",
                   "map '" + path(input) + "' -o '" + path("m.hgmm") + "' " + more);
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }
    void expectRefused(const std::string& input, const std::string& said) const {
        const Outcome outcome = importMap(input);
        EXPECT_EQ(outcome.exitCode, 1) << input;
        expectHas(outcome.err, said);
        EXPECT_FALSE(std::ifstream(path("m.hgmm")).good()) << input;
    }

    template <class Tree>
    Tree roomTree() const {
        Tree tree(0.1);
        forEachCell([&](double x, double y, double z) {
            const State state = roomAt(x, y, z);
            if (state != unknown)
                tree.updateNode(octomap::point3d(x, y, z), state == occupied, true);
        });
        tree.updateInnerOccupancy();
        tree.prune();
        return tree;
    }

    State answerAt(const mrpt::maps::CHGMMOccupancyMap& map, double x, double y,
                   double z) const {
        const hgmm::Occupancy o = map.model().occupancy({x, y, z});
        if (o.occupied > o.free && o.occupied > o.unknown) return occupied;
        return o.free > o.unknown ? free_ : unknown;
    }
    mrpt::maps::CHGMMOccupancyMap imported() const {
        mrpt::maps::CHGMMOccupancyMap map;
        map.loadFromFile(path("m.hgmm"));
        return map;
    }

    /// The layer of the room at 0.5 m as map_server has it: white free, black occupied.
    void writeRosMap(const std::string& more, bool negate = false) const {
        std::string pixels;
        for (int row = 28; row >= -2; --row)
            for (int column = -2; column < 33; ++column) {
                const State state = roomAt((column + .5) * .1, (row + .5) * .1, 0.5);
                const int shade = state == unknown ? 205 : state == free_ ? 254 : 0;
                pixels += static_cast<char>(negate ? 255 - shade : shade);
            }
        write("map.pgm", "P5\n# CREATOR: map_saver\n35 31\n255\n" + pixels);
        write("map.yaml",
              "image: map.pgm\nresolution: 0.1\noccupied_thresh: 0.65\nfree_thresh: "
              "0.196\n" +
                  more);
    }
    /// @param yaw of the map's origin, which is at (-0.2, -0.2) before
    Counts countsOfLayer(double yaw, const Eigen::Vector2d& origin, double height) const {
        const auto map = imported();
        Counts counts;
        for (int y = -2; y < 27; ++y)
            for (int x = -2; x < 33; ++x) {
                const Eigen::Vector2d cell((x + 2.5) * .1, (y + 2.5) * .1);
                const Eigen::Vector2d p = origin + Eigen::Rotation2Dd(yaw) * cell;
                counts.add(roomAt((x + .5) * .1, (y + .5) * .1, 0.5),
                           answerAt(map, p.x(), p.y(), height));
            }
        return counts;
    }
};

TEST_F(ImportMap, OctreesComeBackAsTheyWere) {
    const auto tree = roomTree<octomap::OcTree>();
    auto copy = roomTree<octomap::OcTree>();
    ASSERT_TRUE(tree.write(path("room.ot")));
    ASSERT_TRUE(copy.writeBinary(path("room.bt")));
    ASSERT_TRUE(roomTree<octomap::ColorOcTree>().write(path("colour.ot")));
    for (const std::string name : {"room.bt", "room.ot", "colour.ot"}) {
        const Outcome outcome = importMap(name);
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        expectHas(outcome.out, "all else is unknown");
        const auto map = imported();
        Counts counts;
        forEachCell([&](double x, double y, double z) {
            counts.add(roomAt(x, y, z), answerAt(map, x, y, z));
        });
        counts.expectGood();
    }
    ASSERT_EQ(mapTool("export '" + path("m.hgmm") + "' '" + path("back.bt") +
                      "' --resolution 0.1")
                  .exitCode,
              0);
    octomap::OcTree back(0.1);
    ASSERT_TRUE(back.readBinary(path("back.bt")));
    Counts counts;
    forEachCell([&](double x, double y, double z) {
        const auto* node = back.search(x, y, z);
        const State after = node == nullptr             ? unknown
                            : back.isNodeOccupied(node) ? occupied
                                                        : free_;
        counts.add(roomAt(x, y, z), after);
    });
    counts.expectGood();
}

TEST_F(ImportMap, DamagedOctreesAreRefused) {
    auto tree = roomTree<octomap::OcTree>();
    ASSERT_TRUE(tree.writeBinary(path("room.bt")));
    const std::string whole = content("room.bt");
    write("cut.bt", whole.substr(0, whole.size() / 2));
    write("noise.bt",
          whole.substr(0, whole.find("data\n") + 5) + std::string(4000, '\xFF'));
    write("foreign.ot", "# not a tree\n");
    write("empty.bt", "");
    expectRefused("cut.bt", "cut off");
    expectRefused("noise.bt", "deeper than 16 levels");
    expectRefused("foreign.ot", "no octree");
    expectRefused("empty.bt", "no octree");
    expectRefused("missing.bt", "missing.bt");
}

TEST_F(ImportMap, MapsOfMapServerComeBackAsTheyWere) {
    writeRosMap("origin: [-0.2, -0.2, 0.0]\nnegate: 0\n");
    const Outcome outcome = importMap("map.yaml", "--height 0.5");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    countsOfLayer(0, {-0.2, -0.2}, 0.5).expectGood();
    ASSERT_EQ(mapTool("export '" + path("m.hgmm") + "' '" + path("back.yaml") +
                      "' --height 0.5 --resolution 0.1")
                  .exitCode,
              0);
    std::remove(path("m.hgmm").c_str());
    ASSERT_EQ(importMap("back.yaml", "--height 0.5").exitCode, 0);
    countsOfLayer(0, {-0.2, -0.2}, 0.5).expectGood();
}

TEST_F(ImportMap, OriginsTurnAndPicturesMayBeNegative) {
    writeRosMap("origin: [1001.5, -20, 0.7]\nnegate: 1\nmode: scale\n", true);
    ASSERT_EQ(importMap("map.yaml").exitCode, 0);
    countsOfLayer(0.7, {1001.5, -20}, 0).expectGood();
}

TEST_F(ImportMap, RawPicturesHoldPercent) {
    // Of 255 pixels, column c has the value c: free below 20, occupied above 65, and
    // unknown from 101 on.
    std::string pixels;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 255; ++column) pixels += static_cast<char>(column);
    write("map.pgm", "P5\n255 4\n255\n" + pixels);
    write("map.yaml",
          "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\nmode: raw\n"
          "occupied_thresh: 0.65\nfree_thresh: 0.2\n");
    ASSERT_EQ(importMap("map.yaml").exitCode, 0);
    const auto map = imported();
    EXPECT_EQ(answerAt(map, 1.05, 0.25, 0), free_);
    EXPECT_EQ(answerAt(map, 4.05, 0.25, 0), unknown);
    EXPECT_EQ(answerAt(map, 8.05, 0.25, 0), occupied);
    EXPECT_EQ(answerAt(map, 12.05, 0.25, 0), unknown);
}

TEST_F(ImportMap, WrongDescriptionsAreRefused) {
    const std::string rest = "resolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n";
    write("a.yaml", rest);
    expectRefused("a.yaml", "no 'image'");
    write("b.yaml", "image: none.pgm\n" + rest);
    expectRefused("b.yaml", "no readable picture");
    write("c.yaml", "image: none.pgm\norigin: [0, 0, 0]\n");
    expectRefused("c.yaml", "no 'resolution'");
    write("d.yaml", "image: x.pgm\nresolution: fine\norigin: [0, 0, 0]\n");
    expectRefused("d.yaml", "d.yaml");
    write("e.yaml", "image: x.pgm\nresolution: 0.1\norigin: [0, 0]\n");
    expectRefused("e.yaml", "origin: [x, y, yaw]");
    write("f.yaml", "image: x.pgm\nmode: sepia\n" + rest);
    expectRefused("f.yaml", "sepia");
    write("g.txt", "1 2 3\n");
    expectRefused("g.txt", "none of .bt .ot .yaml");
    writeRosMap("origin: [0, 0, 0]\n");
    const Outcome outcome = importMap("map.yaml", "--units-per-metre 2");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "--units-per-metre");
}

TEST_F(ImportMap, ACloudOfAPlaceHasSurfacesOnly) {
    std::string lines;
    for (int i = 0; i < 50; ++i)
        for (int j = 0; j < 50; ++j)
            lines += std::to_string(20 * i) + " " + std::to_string(20 * j) + " 1000\n";
    lines += "nan nan nan\n";
    write("floor.pcd", import_test::asciiPcd(2501, lines));
    const Outcome outcome = importMap("floor.pcd", "--units-per-metre 1000");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "2500 points, 1 dropped; surfaces only");
    const auto map = imported();
    EXPECT_EQ(answerAt(map, 0.5, 0.5, 1), occupied);
    EXPECT_EQ(answerAt(map, 0.5, 0.5, 1.2), unknown);
}

}  // namespace
