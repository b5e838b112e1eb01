#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "replay_map_fixture.h"

namespace {

/// A map of two walls, exactly known: cells of 0.1 m, free between x = 0 and x = 2, and a
/// block on the floor that is 0.3 m high.
class MapExport : public ReplayFolder {
 protected:
    static constexpr double kEdge_m = 0.1;

    void SetUp() override {
        ReplayFolder::SetUp();
        hgmm::KnownCells cells;
        cells.edge_m = kEdge_m;
        cells.T_map_cells.t = {1000, 0, 0};
        for (int z = 0; z < 10; ++z)
            for (int y = 0; y < 15; ++y)
                for (int x = -1; x < 21; ++x) {
                    const bool isWall = x == -1 || x == 20;
                    const bool isBlock = z < 3 && x > 8 && x < 12 && y > 5 && y < 9;
                    (isWall || isBlock ? cells.occupied : cells.free)
                        .push_back({{x, y, z}, 1});
                }
        mrpt::maps::CHGMMOccupancyMap map;
        map.model() = hgmm::Map::fromCells(cells);
        map.saveToFile(path("m.hgmm"));
    }
    Outcome exportTo(const std::string& name, const std::string& more = "") const {
        return mapTool("export '" + path("m.hgmm") + "' '" + path(name) + "' " + more);
    }
};

/// What a glTF file says, read as the specification has it.
struct Gltf {
    nlohmann::json json;
    std::string binary;

    explicit Gltf(const std::string& file) {
        EXPECT_EQ(file.substr(0, 4), "glTF");
        EXPECT_EQ(word(file, 4), 2U);
        EXPECT_EQ(word(file, 8), file.size());
        const std::size_t length = word(file, 12);
        EXPECT_EQ(length % 4, 0U);
        EXPECT_EQ(file.substr(16, 4), "JSON");
        json = nlohmann::json::parse(file.substr(20, length));
        EXPECT_EQ(file.substr(24 + length, 4), std::string("BIN\0", 4));
        binary = file.substr(28 + length);
        EXPECT_EQ(word(file, 20 + length), binary.size());
        EXPECT_EQ(json["asset"]["version"], "2.0");
        EXPECT_EQ(json["buffers"][0]["byteLength"], binary.size());
        EXPECT_FALSE(json.contains("extensionsRequired"));
    }
    static std::uint32_t word(const std::string& bytes, std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    }
    /// Values of an accessor of floats or 16-bit indices.
    template <typename T>
    std::vector<T> values(std::size_t accessor, int perElement) const {
        const auto& a = json["accessors"][accessor];
        EXPECT_EQ(a["componentType"], sizeof(T) == 4 ? 5126 : 5123);
        const auto& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        const std::size_t offset = view["byteOffset"], n = a["count"];
        EXPECT_EQ(offset % sizeof(T), 0U);
        EXPECT_EQ(view["byteLength"], n * perElement * sizeof(T));
        EXPECT_LE(offset + n * perElement * sizeof(T), binary.size());
        std::vector<T> values(n * perElement);
        std::memcpy(values.data(), binary.data() + offset, values.size() * sizeof(T));
        return values;
    }
    static Eigen::VectorXd vectorOf(const nlohmann::json& numbers) {
        const auto values = numbers.get<std::vector<double>>();
        return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                                 static_cast<Eigen::Index>(values.size()));
    }
};

TEST_F(MapExport, GltfNodesAreTheEllipsoids) {
    ASSERT_EQ(exportTo("m.glb").exitCode, 0);
    const Gltf gltf(content("m.glb"));
    const auto positions = gltf.values<float>(0, 3);
    for (std::size_t i = 0; i < positions.size(); i += 3)
        EXPECT_NEAR(std::hypot(positions[i], positions[i + 1], positions[i + 2]), 1, 1e-6);
    for (int axis = 0; axis < 3; ++axis) {
        float low = 2, high = -2;
        for (std::size_t i = 0; i < positions.size(); i += 3) {
            low = std::min(low, positions[i + axis]);
            high = std::max(high, positions[i + axis]);
        }
        EXPECT_EQ(gltf.json["accessors"][0]["min"][axis].get<float>(), low);
        EXPECT_EQ(gltf.json["accessors"][0]["max"][axis].get<float>(), high);
    }
    // Faces are turned outwards.
    const auto indices = gltf.values<std::uint16_t>(1, 1);
    ASSERT_EQ(indices.size() % 3, 0U);
    const auto vertex = [&](std::size_t i) {
        EXPECT_LT(std::size_t(3 * indices[i] + 2), positions.size());
        return Eigen::Vector3f(Eigen::Vector3f::Map(&positions[3 * indices[i]]));
    };
    for (std::size_t i = 0; i < indices.size(); i += 3)
        EXPECT_GT(
            (vertex(i + 1) - vertex(i)).cross(vertex(i + 2) - vertex(i)).dot(vertex(i)), 0);

    mrpt::maps::CHGMMOccupancyMap map;
    map.loadFromFile(path("m.hgmm"));
    const auto& nodes = gltf.json["nodes"];
    ASSERT_EQ(nodes.size(), map.model().mixture().size() + 1);
    ASSERT_EQ(nodes[0]["children"].size() + 1, nodes.size());
    EXPECT_EQ(Gltf::vectorOf(nodes[0]["extras"]["origin_m"]), map.model().origin());
    // The map's z is glTF's y.
    const auto q = Gltf::vectorOf(nodes[0]["rotation"]);
    EXPECT_TRUE((Eigen::Quaterniond(q[3], q[0], q[1], q[2]) * Eigen::Vector3d::UnitZ())
                    .isApprox(Eigen::Vector3d::UnitY(), 1e-9));
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const auto& node = nodes[i + 1];
        EXPECT_EQ(nodes[0]["children"][i], i + 1);
        EXPECT_LT(node["mesh"].get<std::size_t>(), gltf.json["meshes"].size());
        const auto r = Gltf::vectorOf(node["rotation"]);
        ASSERT_NEAR(r.norm(), 1, 1e-6);
        const Eigen::Matrix3d A =
            Eigen::Quaterniond(r[3], r[0], r[1], r[2]).toRotationMatrix() *
            Eigen::Vector3d(Gltf::vectorOf(node["scale"])).asDiagonal();
        const auto g = map.model().mixture()[i];
        const Eigen::Matrix3d covariance = g.covariance;
        EXPECT_LT((A * A.transpose() - 4 * covariance).norm(), 1e-4 * covariance.norm());
        EXPECT_LT((Gltf::vectorOf(node["translation"]) - g.mean).norm(), 1e-5);
    }
}

TEST_F(MapExport, BandsAreOccupiedWhereAnythingInThemIs) {
    const auto countOf = [&](const std::string& name, unsigned char value) {
        const std::string picture = content(name);
        const std::string cells = picture.substr(picture.find("255\n") + 4);
        return std::count(cells.begin(), cells.end(), static_cast<char>(value));
    };
    const std::string edge = " --resolution 0.1";
    ASSERT_EQ(exportTo("low.yaml", "--height 0.15" + edge).exitCode, 0);
    ASSERT_EQ(exportTo("high.yaml", "--height 0.75" + edge).exitCode, 0);
    ASSERT_EQ(exportTo("band.yaml", "--band 0.1,0.8" + edge).exitCode, 0);
    ASSERT_EQ(exportTo("above.yaml", "--band 0.4,0.8" + edge).exitCode, 0);
    // Walls reach a little past their ends.
    EXPECT_GE(countOf("high.pgm", 0), 2 * 15);
    EXPECT_LE(countOf("high.pgm", 0), 2 * 17);
    EXPECT_GE(countOf("band.pgm", 0), countOf("above.pgm", 0) + 9);
    EXPECT_GE(countOf("band.pgm", 0), countOf("low.pgm", 0));
    EXPECT_GE(countOf("low.pgm", 0), countOf("high.pgm", 0) + 9 - 4);
    EXPECT_LE(countOf("above.pgm", 0), 2 * 17);
    EXPECT_EQ(countOf("band.pgm", 254), 20 * 15 - 9);
    EXPECT_EQ(exportTo("x.yaml", "--band 0.8,0.1").exitCode, 2);
    EXPECT_EQ(exportTo("x.yaml", "--band 0.1,0.8 --height 1").exitCode, 2);
    EXPECT_EQ(exportTo("x.yaml").exitCode, 2);
    EXPECT_EQ(exportTo("x.yaml", "--band 5,6").exitCode, 1);
}

TEST_F(MapExport, DistancesAreThoseToTheWalls) {
    ASSERT_EQ(exportTo("d.csv", "--height 0.75 --resolution 0.1").exitCode, 0);
    std::istringstream lines(content("d.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line,
              "x,y,z,distance_m,distance_std_m,distance_known,p_occ,p_free,p_unknown");
    int rows = 0;
    while (std::getline(lines, line)) {
        double x = 0, y = 0, z = 0, distance = 0, deviation = 0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &distance,
                              &deviation),
                  5)
            << line;
        ++rows;
        // Surfaces are in the middle of their cells; the block's top is at 0.25 m.
        const double toWall = std::min(std::abs(x - 999.95), std::abs(x - 1002.05));
        const double toTop = std::hypot(0.5, std::max(0.0, std::abs(x - 1001.05) - 0.15),
                                        std::max(0.0, std::abs(y - 0.75) - 0.15));
        if (y > 0.2 && y < 1.3) {
            EXPECT_NEAR(distance, std::min(toWall, toTop), 0.06) << line;
        }
        EXPECT_LT(deviation, 0.1);
    }
    // Walls reach a little past their ends.
    EXPECT_GE(rows, 22 * 15);
    EXPECT_LE(rows, 24 * 17);

    const Outcome outcome =
        exportTo("d.pgm", "--height 0.75 --resolution 0.1 --max-distance 2");
    ASSERT_EQ(outcome.exitCode, 0);
    expectHas(outcome.out, "distance: 0 to 254 are 0 to 2 m");
    const std::string picture = content("d.pgm");
    int width = 0, height = 0;
    const std::size_t size = picture.find('\n', picture.find('#')) + 1;
    ASSERT_EQ(std::sscanf(picture.c_str() + size, "%d %d", &width, &height), 2);
    EXPECT_EQ(width * height, rows);
    const std::string cells = picture.substr(picture.find("\n255\n") + 5);
    ASSERT_EQ(cells.size(), std::size_t(rows));
    // In the middle row, the darkest cell of the western half is the wall's, and three
    // cells on it is 0.3 m away.
    const auto shade = [&](int column) {
        return int(static_cast<unsigned char>(cells[height / 2 * width + column]));
    };
    int wall = 0;
    for (int column = 1; column < width / 3; ++column)
        if (shade(column) < shade(wall)) wall = column;
    EXPECT_NEAR(shade(wall), 0, 5);
    EXPECT_NEAR(shade(wall + 3), 254 * 0.3 / 2, 5);
    EXPECT_EQ(exportTo("s.pgm", "--height 0.75 --show deviation").exitCode, 0);
    EXPECT_EQ(exportTo("d.csv", "--height 0.75 --show deviation").exitCode, 2);
    EXPECT_EQ(exportTo("d.csv").exitCode, 2);
}

}  // namespace
