#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

#include "replay_map_fixture.h"

namespace {

/// hgmm-map on a saved map of the box room, whose walls are at box_room::kHalf_m.
/// Resolutions are such that no wall looked at lies on the border of cells.
class MapOccupancy : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        mrpt::maps::CHGMMOccupancyMap map;
        for (std::size_t i = 0; i < 8; ++i) {
            const auto pose = box_room::robotPose(i);
            map.insertObservation(
                *box_room::pointCloud(pose, box_room::timeOfScan(i), 4000), pose);
        }
        map.saveToFile(path("m.hgmm"));
    }

    /// The words of each line of an answer, comments left out.
    static std::vector<std::vector<std::string>> words(const std::string& text) {
        std::vector<std::vector<std::string>> lines;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) {
            if (line.empty() || line[0] == '#') continue;
            std::istringstream words(line);
            lines.emplace_back();
            for (std::string word; words >> word;) lines.back().push_back(word);
        }
        return lines;
    }

    void expectRefused(const std::string& arguments, int exitCode,
                       const std::string& said) const {
        const Outcome outcome = mapTool(arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << arguments << "\n" << outcome.err;
        expectHas(outcome.err, said);
    }

    std::unique_ptr<octomap::OcTree> readTree(const std::string& name) const {
        if (name.substr(name.size() - 3) == ".bt") {
            auto tree = std::make_unique<octomap::OcTree>(1.0);
            return tree->readBinary(path(name)) ? std::move(tree) : nullptr;
        }
        std::unique_ptr<octomap::AbstractOcTree> tree(
            octomap::AbstractOcTree::read(path(name)));
        auto* ours = dynamic_cast<octomap::OcTree*>(tree.get());
        if (ours) tree.release();
        return std::unique_ptr<octomap::OcTree>(ours);
    }
};

struct RosMap {
    std::size_t width = 0, height = 0;
    double resolution_m = 0, x_m = 0, y_m = 0;
    std::string cells;

    int at(double x, double y) const {
        const auto col = static_cast<std::size_t>((x - x_m) / resolution_m);
        const auto row = static_cast<std::size_t>((y - y_m) / resolution_m);
        if (col >= width || row >= height) return -1;
        return static_cast<unsigned char>(cells[(height - 1 - row) * width + col]);
    }
};

RosMap parse(const std::string& yaml, const std::string& pgm) {
    RosMap map;
    std::istringstream lines(yaml);
    for (std::string line; std::getline(lines, line);) {
        std::sscanf(line.c_str(), "resolution: %lf", &map.resolution_m);
        std::sscanf(line.c_str(), "origin: [%lf, %lf", &map.x_m, &map.y_m);
    }
    std::istringstream header(pgm);
    std::string magic;
    int most = 0;
    header >> magic >> map.width >> map.height >> most;
    EXPECT_EQ(magic, "P5");
    EXPECT_EQ(most, 255);
    header.get();
    map.cells = pgm.substr(static_cast<std::size_t>(header.tellg()));
    EXPECT_EQ(map.cells.size(), map.width * map.height);
    return map;
}

}  // namespace

TEST_F(MapOccupancy, QueryTellsWallFromRoomAndOutside) {
    const Outcome outcome =
        mapTool("query " + path("m.hgmm") + " 4,0.5,0.2 1.5,-1,0.3 9,0,0 -4,-1.2,0.1");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto lines = words(outcome.out);
    ASSERT_EQ(lines.size(), 4U) << outcome.out;
    EXPECT_EQ(lines[0][3], "occupied");
    EXPECT_EQ(lines[1][3], "free");
    EXPECT_EQ(lines[2][3], "unknown");
    EXPECT_EQ(lines[3][3], "occupied");
    EXPECT_EQ(lines[3][0], "-4") << "a negative number is no option";
    for (const auto& line : lines) {
        ASSERT_EQ(line.size(), 9U);
        EXPECT_NEAR(std::stod(line[4]) + std::stod(line[5]) + std::stod(line[6]), 1.0,
                    2e-4);
    }
    EXPECT_NEAR(std::stod(lines[0][7]), 0.0, 0.1) << "distance to the wall";
    EXPECT_GT(std::stod(lines[1][7]), 0.3) << "distance in the middle of the room";
    EXPECT_GE(std::stod(lines[1][8]), 0.0);
    EXPECT_EQ(lines[2][7], "-");
}

TEST_F(MapOccupancy, QueryReadsPointsFromAFile) {
    std::ofstream(path("points.txt")) << "# x y z\n4 0.5 0.2\n\n  1.5\t-1 0.3\r\n";
    const Outcome file =
        mapTool("query " + path("m.hgmm") + " --points " + path("points.txt"));
    const Outcome arguments = mapTool("query " + path("m.hgmm") + " 4,0.5,0.2 1.5,-1,0.3");
    ASSERT_EQ(file.exitCode, 0) << file.err;
    EXPECT_EQ(file.out, arguments.out);
    const Outcome coarse =
        mapTool("query " + path("m.hgmm") + " 4,0.5,0.2 1.5,-1,0.3 --level 4");
    ASSERT_EQ(coarse.exitCode, 0) << coarse.err;
    EXPECT_NE(coarse.out, arguments.out);
}

TEST_F(MapOccupancy, QueryRefusesBadInput) {
    const std::string map = path("m.hgmm");
    expectRefused("query " + map + " 1,2", 1, "three numbers x,y,z");
    expectRefused("query " + map + " 1,2,nan", 1, "'nan' is not a finite number");
    expectRefused("query " + map + " 1,2,3 --level 9", 1, "levels are 0 to");
    expectRefused("query " + path("none.hgmm") + " 1,2,3", 1, "none.hgmm");
    expectRefused("query " + map + " --points " + path("none.txt"), 1, "none.txt");
    std::ofstream(path("bad.txt")) << "1 2 3\n4 five 6\n";
    expectRefused("query " + map + " --points " + path("bad.txt"), 1, "bad.txt:2");
    expectRefused("query " + map, 2, "--points FILE");
}

TEST_F(MapOccupancy, RaycastFindsTheWall) {
    const std::string map = path("m.hgmm");
    const Outcome hit =
        mapTool("raycast " + map + " --from 0.5,0,0.2 --to-direction -2,0,0");
    ASSERT_EQ(hit.exitCode, 0) << hit.err;
    const auto lines = words(hit.out);
    ASSERT_EQ(lines.size(), 1U) << hit.out;
    EXPECT_NEAR(std::stod(lines[0][0]), -4.0, 0.1);
    EXPECT_NEAR(std::stod(lines[0][3]), 4.5, 0.1);
    const Outcome miss =
        mapTool("raycast " + map + " --from 0.5,0,0.2 --to-direction -2,0,0 --max-range 2");
    EXPECT_EQ(miss.exitCode, 0);
    expectHas(miss.out, "nothing occupied within 2 m");
    expectRefused("raycast " + map + " --from 0,0,0 --to-direction 0,0,0", 1, "direction");
    expectRefused("raycast " + map + " --from 0,0 --to-direction 1,0,0", 1, "--from");
    expectRefused("raycast " + map + " --from 0,0,0", 2, "--to-direction");
}

TEST_F(MapOccupancy, OctreesHoldWallsAndFreeSpace) {
    for (const std::string name : {"m.ot", "m.bt"}) {
        const Outcome outcome =
            mapTool("export " + path("m.hgmm") + " " + path(name) + " --resolution 0.09");
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const auto tree = readTree(name);
        ASSERT_TRUE(tree) << name;
        EXPECT_NEAR(tree->getResolution(), 0.09, 1e-9);
        const auto* wall = tree->search(4.0, 0.55, 0.25);
        ASSERT_TRUE(wall) << name;
        EXPECT_TRUE(tree->isNodeOccupied(wall)) << name;
        const auto* inside = tree->search(1.55, -0.95, 0.35);
        ASSERT_TRUE(inside) << name << ": free space";
        EXPECT_FALSE(tree->isNodeOccupied(inside)) << name;
        EXPECT_FALSE(tree->search(6.0, 0.5, 0.2)) << name << ": nobody saw it";
        EXPECT_LE(tree->getRoot()->getOccupancy(), tree->getClampingThresMax() + 1e-6);
        std::size_t merged = 0;
        for (auto leaf = tree->begin_leafs(); leaf != tree->end_leafs(); ++leaf)
            merged += leaf.getSize() > 0.15 ? 1 : 0;
        EXPECT_GT(merged, 10U) << name << ": not pruned";
    }
    EXPECT_LT(std::filesystem::file_size(path("m.bt")),
              std::filesystem::file_size(path("m.ot")));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path(".")), {}), 5)
        << "map, two trees, and what the program printed";
}

TEST_F(MapOccupancy, ExportChoosesAResolutionIfNoneIsGiven) {
    ASSERT_EQ(mapTool("export " + path("m.hgmm") + " " + path("m.ot")).exitCode, 0);
    const auto tree = readTree("m.ot");
    ASSERT_TRUE(tree);
    EXPECT_GT(tree->getResolution(), 0.02);
    EXPECT_LT(tree->getResolution(), 0.6);
}

TEST_F(MapOccupancy, SliceIsARosMapOfTheRoom) {
    const Outcome outcome = mapTool("export " + path("m.hgmm") + " " + path("room.yaml") +
                                    " --height 0.25 --resolution 0.08");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::string yaml = content("room.yaml");
    for (const char* line : {"image: room.pgm\n", "resolution: 0.08\n", "negate: 0\n",
                             "occupied_thresh: ", "free_thresh: 0.19\n"})
        expectHas(yaml, line);
    const RosMap map = parse(yaml, content("room.pgm"));
    EXPECT_EQ(map.resolution_m, 0.08);
    int walls = 0, occupied = 0, inside = 0, free = 0;
    for (double x = -3.0; x < 3.0; x += 0.05)
        for (const double y : {-3.0, 3.0}) {
            ++walls;
            occupied += map.at(x, y) == 0 ? 1 : 0;
        }
    for (double x = -3.5; x < 3.5; x += 0.1)
        for (double y = -2.5; y < 2.5; y += 0.1) {
            ++inside;
            free += map.at(x, y) == 254 ? 1 : 0;
        }
    EXPECT_GT(occupied, 0.97 * walls);
    EXPECT_GT(free, 0.97 * inside);
    for (const char c : map.cells) {
        const int cell = static_cast<unsigned char>(c);
        ASSERT_TRUE(cell == 0 || cell == 205 || cell == 254) << cell;
    }
    // Well behind the walls, cells are unknown or not even part of the picture.
    for (double y = -2.0; y < 2.0; y += 0.1)
        for (const double x : {-4.3, 4.3})
            EXPECT_TRUE(map.at(x, y) == 205 || map.at(x, y) == -1) << x << " " << y;
}

TEST_F(MapOccupancy, ExportRefusesWhatCannotBe) {
    const std::string map = "export " + path("m.hgmm") + " ";
    expectRefused(map + path("m.xyz"), 2, "--format");
    expectRefused(map + path("m.yaml"), 2, "--height");
    expectRefused(map + path("m.bt") + " --height 1", 2, "--height");
    expectRefused(map + path("m.ply") + " --resolution 1", 2, "--resolution");
    expectRefused(map + path("m.bt") + " --resolution 0", 2, "--resolution");
    expectRefused(map + path("m.bt") + " --resolution 0.0002", 1, "choose a larger one");
    expectRefused(map + path("m.bt") + " --level 9", 1, "levels are 0 to");
    expectRefused(map + path("m.yaml") + " --height 500", 1, "knows nothing at a height");
    expectRefused(map + path("no/folder/m.ot") + " --resolution 0.2", 1, "m.ot");
    EXPECT_FALSE(std::filesystem::exists(path("m.bt"))) << "nothing half done";
    mrpt::maps::CHGMMOccupancyMap().saveToFile(path("empty.hgmm"));
    expectRefused("export " + path("empty.hgmm") + " " + path("m.bt"), 1, "empty");
}

// In UTM coordinates (whole metres, as the origins of maps are), a tree that is shifted
// back holds what the tree at the origin holds.
TEST_F(MapOccupancy, OctreeOfAFarMapTakesAnOffset) {
    const mrpt::poses::CPose3D offsets[] = {{0, 0, 0, 0, 0, 0},
                                            {448262, 5411933, 120, 0, 0, 0}};
    for (const auto& offset : offsets) {
        mrpt::maps::CHGMMOccupancyMap map;
        map.insertObservation(
            *box_room::pointCloud(mrpt::poses::CPose3D(), box_room::timeOfScan(0), 4000),
            offset);
        map.saveToFile(path(offset.x() == 0 ? "near.hgmm" : "utm.hgmm"));
    }
    const std::string utm = "export " + path("utm.hgmm") + " " + path("utm.ot") + " ";
    expectRefused(utm + "--resolution 0.2", 1, "--offset");
    expectRefused(utm + "--offset 1,2", 2, "--offset");
    expectRefused(utm + "--offset 1,2,nan", 2, "--offset");
    expectRefused(utm + "--local --offset 1,2,3", 2, "--local");
    expectRefused("export " + path("utm.hgmm") + " " + path("utm.ply") + " --local", 2,
                  "--local");
    ASSERT_EQ(
        mapTool("export " + path("near.hgmm") + " " + path("near.ot") + " --resolution 0.2")
            .exitCode,
        0);
    const auto nearTree = readTree("near.ot");
    for (const std::string option : {"--offset 448262.07,5411932.95,120.02", "--local"}) {
        ASSERT_EQ(mapTool(utm + "--resolution 0.2 " + option).exitCode, 0);
        std::ifstream file(path("utm.offset.txt"));
        double x = 0, y = 0, z = 0;
        ASSERT_TRUE(file >> x >> y >> z);
        EXPECT_NEAR(x, 448262, option == "--local" ? 20 : 0.11);
        const auto tree = readTree("utm.ot");
        ASSERT_TRUE(tree && nearTree);
        EXPECT_NEAR(static_cast<double>(tree->size()),
                    static_cast<double>(nearTree->size()), 0.1 * double(nearTree->size()));
        std::size_t same = 0, all = 0;
        for (auto leaf = nearTree->begin_leafs(); leaf != nearTree->end_leafs(); ++leaf) {
            const auto p = leaf.getCoordinate();
            const auto* other = tree->search(p.x() + 448262.0 - x, p.y() + 5411933.0 - y,
                                             p.z() + 120.0 - z);
            ++all;
            same += other && tree->isNodeOccupied(other) == nearTree->isNodeOccupied(*leaf);
        }
        EXPECT_GT(static_cast<double>(same), 0.99 * static_cast<double>(all));
    }
}

// An octree has 32768 cells to each side of the map frame's origin, wherever the map is.
TEST_F(MapOccupancy, OctreeOfAFarMapIsRefusedOrRight) {
    mrpt::maps::CHGMMOccupancyMap map;
    const mrpt::poses::CPose3D far(5000.1, -200, 3, 0, 0, 0);
    map.insertObservation(
        *box_room::pointCloud(mrpt::poses::CPose3D(), box_room::timeOfScan(0), 4000), far);
    map.saveToFile(path("far.hgmm"));
    expectRefused("export " + path("far.hgmm") + " " + path("far.bt") + " --resolution 0.1",
                  1, "larger --resolution");
    ASSERT_EQ(
        mapTool("export " + path("far.hgmm") + " " + path("far.bt") + " --resolution 0.2")
            .exitCode,
        0);
    const auto tree = readTree("far.bt");
    ASSERT_TRUE(tree);
    const auto* wall = tree->search(5004.1, -199.5, 3.25);
    ASSERT_TRUE(wall);
    EXPECT_TRUE(tree->isNodeOccupied(wall));
}

TEST_F(MapOccupancy, SceneWithVoxelsIsWritten) {
    const std::string map = "export " + path("m.hgmm") + " ";
    ASSERT_EQ(mapTool(map + path("e.3Dscene")).exitCode, 0);
    ASSERT_EQ(mapTool(map + path("v.3Dscene") + " --voxels --resolution 0.1").exitCode, 0);
    EXPECT_NE(content("v.3Dscene"), content("e.3Dscene"));
    EXPECT_GT(std::filesystem::file_size(path("v.3Dscene")), 10000U);
    ASSERT_EQ(
        mapTool(map + path("c.3Dscene") + " --colour deviation --free-space").exitCode, 0);
    EXPECT_NE(content("c.3Dscene"), content("e.3Dscene"));
    expectRefused(map + path("v.3Dscene") + " --free-voxels", 2, "--voxels");
    expectRefused(map + path("v.3Dscene") + " --colour taste", 2, "--colour");
    expectRefused(map + path("v.ply") + " --voxels", 2, "--voxels");
}
