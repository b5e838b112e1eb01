#include <cstring>
#include <sstream>

#include "replay_map_fixture.h"

namespace {

/// A binary PLY file as far as these tests look at it.
struct ReadPly {
    std::size_t vertices = 0, faces = 0;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> components;
};

ReadPly parsePly(const std::string& bytes) {
    ReadPly ply;
    const std::string end = "end_header\n";
    const std::size_t body = bytes.find(end);
    if (body == std::string::npos) return ply;
    std::istringstream header(bytes.substr(0, body));
    bool coloured = false;
    for (std::string line; std::getline(header, line);) {
        std::sscanf(line.c_str(), "element vertex %zu", &ply.vertices);
        std::sscanf(line.c_str(), "element face %zu", &ply.faces);
        coloured = coloured || line == "property uint component";
    }
    const std::size_t stride = coloured ? 24 + 3 + 4 : 24;
    const char* at = bytes.data() + body + end.size();
    EXPECT_EQ(bytes.size() - body - end.size(), ply.vertices * stride + ply.faces * 13);
    for (std::size_t i = 0; i < ply.vertices; ++i, at += stride) {
        Eigen::Vector3d p;
        std::memcpy(p.data(), at, 24);
        ply.points.push_back(p);
        std::uint32_t component = 0;
        if (coloured) std::memcpy(&component, at + 27, 4);
        ply.components.push_back(component);
    }
    return ply;
}

class MapTool : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        ASSERT_EQ(replay(recordRoom() + " --quiet --report " + path("report") +
                         " --save-map " + path("m.hgmm"))
                      .exitCode,
                  0);
        components_ = metrics("report")["maps"][0]["levels"];
    }
    std::size_t componentsAt(int level) const {
        return components_.at(level)["components"];
    }

    nlohmann::json components_;
};

}  // namespace

TEST_F(MapTool, InfoTellsWhatReplayDid) {
    const Outcome outcome = mapTool("info " + path("m.hgmm"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, std::to_string(componentsAt(0)));
    expectHas(outcome.out, "origin");
    expectHas(outcome.out, "levels");
    double low = 0, high = 0;
    ASSERT_EQ(std::sscanf(outcome.out.c_str() + outcome.out.find("extent x"),
                          "extent x %lf to %lf", &low, &high),
              2);
    // A component may hold a corner, and so reach a little outside.
    EXPECT_NEAR(low, -4.5, 1.0);
    EXPECT_NEAR(high, 4.5, 1.0);
}

TEST_F(MapTool, SamplesLieOnTheWalls) {
    ASSERT_EQ(mapTool("sample " + path("m.hgmm") + " -n 5000 -o " + path("s.ply")).exitCode,
              0);
    const ReadPly ply = parsePly(content("s.ply"));
    ASSERT_EQ(ply.vertices, 5000U);
    double sum = 0;
    for (const auto& p : ply.points) sum += box_room::distanceToWalls(p);
    EXPECT_LT(sum / 5000, 0.15);
    ASSERT_EQ(mapTool("sample " + path("m.hgmm") + " -n 5000 -o " + path("t.ply")).exitCode,
              0);
    EXPECT_TRUE(content("s.ply") == content("t.ply"));
    ASSERT_EQ(mapTool("sample " + path("m.hgmm") + " -n 5000 --seed 2 -o " + path("t.ply"))
                  .exitCode,
              0);
    EXPECT_FALSE(content("s.ply") == content("t.ply"));
}

TEST_F(MapTool, ExportsOneClosedEllipsoidPerComponent) {
    for (const int level : {0, 2}) {
        ASSERT_EQ(mapTool("export " + path("m.hgmm") + " --format ply --level " +
                          std::to_string(level) + " -o " + path("e.ply"))
                      .exitCode,
                  0);
        const ReadPly ply = parsePly(content("e.ply"));
        EXPECT_EQ(ply.vertices, 42 * componentsAt(level));
        EXPECT_EQ(ply.faces, 80 * componentsAt(level));
        EXPECT_EQ(ply.components.back() + 1, componentsAt(level));
    }
}

TEST_F(MapTool, ExportsPointsOfEachComponent) {
    ASSERT_EQ(mapTool("export " + path("m.hgmm") +
                      " --format ply --points-per-component 7 -o " + path("p.ply"))
                  .exitCode,
              0);
    const ReadPly ply = parsePly(content("p.ply"));
    ASSERT_EQ(ply.vertices, 7 * componentsAt(0));
    EXPECT_EQ(ply.faces, 0U);
    for (std::size_t i = 0; i < ply.vertices; ++i) EXPECT_EQ(ply.components[i], i / 7);
}

TEST_F(MapTool, ExportsAScene) {
    ASSERT_EQ(
        mapTool("export " + path("m.hgmm") + " --format 3Dscene -o " + path("m.3Dscene"))
            .exitCode,
        0);
    EXPECT_GT(std::filesystem::file_size(path("m.3Dscene")), 1000U);
}

TEST_F(MapTool, BadInputIsOneAndWrongUsageTwo) {
    const std::string map = path("m.hgmm"), out = " -o " + path("x.ply");
    const Outcome missing = mapTool("info " + path("missing.hgmm"));
    EXPECT_EQ(missing.exitCode, 1);
    expectHas(missing.err, "missing.hgmm");
    std::ofstream(path("text.hgmm")) << "no map";
    EXPECT_EQ(mapTool("info " + path("text.hgmm")).exitCode, 1);
    std::filesystem::copy_file(map, path("half.hgmm"));
    box_room::truncateFile(path("half.hgmm"), 0.5);
    EXPECT_EQ(mapTool("info " + path("half.hgmm")).exitCode, 1);
    const Outcome level = mapTool("export " + map + " --format ply --level 99" + out);
    EXPECT_EQ(level.exitCode, 1);
    expectHas(level.err, "levels are 0 to");
    EXPECT_EQ(mapTool("sample " + map + " -n 5 -o " + path("no/folder/x.ply")).exitCode, 1);
    EXPECT_EQ(mapTool("").exitCode, 2);
    EXPECT_EQ(mapTool("frobnicate").exitCode, 2);
    EXPECT_EQ(mapTool("sample " + map + out).exitCode, 2);
    EXPECT_EQ(mapTool("sample " + map + " -n -5" + out).exitCode, 2);
    EXPECT_EQ(mapTool("export " + map + " --format obj" + out).exitCode, 2);
    EXPECT_EQ(mapTool("export " + map + " --format 3Dscene --points-per-component 3" + out)
                  .exitCode,
              2);
}
