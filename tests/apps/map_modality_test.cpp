#include <cstring>
#include <sstream>

#include "coloured_room.h"
#include "replay_map_fixture.h"

namespace {

class MapModality : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        box_room::writeRawlog(path("room.rawlog"), coloured_room::withColours(6, 8000));
        box_room::writePoses(path("room.tum"), 6);
        std::ofstream(path("rgb.ini"))
            << "[m]\nhgmmMap_count = 1\n[m_hgmmMap_00_insertOpts]\nmodalities = rgb\n";
        const std::string room =
            "'" + path("room.rawlog") + "' --poses '" + path("room.tum") + "' --quiet";
        ASSERT_EQ(replay(room + " --config " + path("rgb.ini") + " --save-map " +
                         path("rgb.hgmm"))
                      .exitCode,
                  0);
        ASSERT_EQ(replay(room + " --save-map " + path("plain.hgmm")).exitCode, 0);
    }
    std::string coloured() const { return path("rgb.hgmm"); }
    std::string plain() const { return path("plain.hgmm"); }
};

/// The words of the line after the header that begins with '#'.
std::vector<std::string> answerOf(const std::string& out) {
    std::istringstream lines(out);
    std::string line;
    while (std::getline(lines, line) && line[0] == '#') {
    }
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

TEST_F(MapModality, InfoListsThem) {
    const Outcome outcome = mapTool("info " + coloured());
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const char* name : {"\nr ", "\ng ", "\nb "}) {
        const auto at = outcome.out.find(name);
        ASSERT_NE(at, std::string::npos) << outcome.out;
        std::size_t components = 0, bytes = 0;
        ASSERT_EQ(std::sscanf(outcome.out.c_str() + at + 2, "%zu %zu", &components, &bytes),
                  2);
        EXPECT_GT(components, 5U);
        EXPECT_GT(bytes, 20U);
    }
    EXPECT_EQ(mapTool("info " + plain()).out.find("modality  "), std::string::npos);
}

TEST_F(MapModality, QueryAddsMeanAndVarianceOfEach) {
    const Outcome outcome =
        mapTool("query " + coloured() + " --modality b,r -- 4,1.5,0.3 -4,-1.5,0.3");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "b b_variance, r r_variance\n");
    const auto words = answerOf(outcome.out);
    ASSERT_EQ(words.size(), 9U + 4U);
    const Eigen::Vector3d truth = coloured_room::colourAt({4, 1.5, 0.3});
    EXPECT_NEAR(std::stod(words[9]), truth[2], 0.05);
    EXPECT_NEAR(std::stod(words[11]), truth[0], 0.05);
    EXPECT_GE(std::stod(words[12]), 0.0);
    EXPECT_LT(std::stod(words[12]), 0.01);

    const auto all =
        answerOf(mapTool("query " + coloured() + " 4,1.5,0.3 --modality rgb").out);
    ASSERT_EQ(all.size(), 9U + 6U);
    EXPECT_NEAR(std::stod(all[11]), truth[1], 0.05);
    const auto nowhere =
        answerOf(mapTool("query " + coloured() + " 400,1.5,0.3 --modality r").out);
    ASSERT_EQ(nowhere.size(), 9U + 2U);
    EXPECT_EQ(nowhere[9], "-");
}

TEST_F(MapModality, SamplesHaveTheColoursOfTheWalls) {
    ASSERT_EQ(
        mapTool("sample " + coloured() + " -n 3000 --color -o " + path("s.ply")).exitCode,
        0);
    const std::string bytes = content("s.ply");
    expectHas(bytes, "property uchar red");
    const std::string end = "end_header\n";
    const std::size_t body = bytes.find(end) + end.size();
    ASSERT_EQ(bytes.size() - body, 3000U * 27U);
    double error = 0;
    int compared = 0;
    for (int i = 0; i < 3000; ++i) {
        Eigen::Vector3d p;
        std::memcpy(p.data(), bytes.data() + body + 27 * i, 24);
        if (std::abs(p.y()) < 0.3) continue;  // about the edge between two greens
        const Eigen::Vector3d truth = coloured_room::colourAt(p);
        for (int c = 0; c < 3; ++c) {
            const auto byte = static_cast<std::uint8_t>(bytes[body + 27 * i + 24 + c]);
            error += std::abs(byte / 255.0 - truth[c]);
        }
        ++compared;
    }
    EXPECT_GT(compared, 2000);
    EXPECT_LT(error / (3 * compared), 0.05);
}

TEST_F(MapModality, ScenesShowThem) {
    EXPECT_EQ(mapTool("export " + coloured() + " " + path("m.3Dscene") +
                      " --colour modality --modality r")
                  .exitCode,
              0);
    EXPECT_GT(std::filesystem::file_size(path("m.3Dscene")), 1000U);
    const Outcome missing =
        mapTool("export " + plain() + " " + path("n.3Dscene") + " --colour modality");
    EXPECT_EQ(missing.exitCode, 1);
    expectHas(missing.err, "modalities = rgb");
}

TEST_F(MapModality, MissingModalitiesAreBadInput) {
    const Outcome none = mapTool("query " + plain() + " --modality r 1,1,1");
    EXPECT_EQ(none.exitCode, 1);
    expectHas(none.err, "plain.hgmm");
    expectHas(none.err, "modalities = rgb");
    const Outcome other = mapTool("query " + coloured() + " --modality heat 1,1,1");
    EXPECT_EQ(other.exitCode, 1);
    expectHas(other.err, "'heat'");
    expectHas(other.err, "r, g, b");
    EXPECT_EQ(mapTool("sample " + plain() + " -n 5 --color -o " + path("x.ply")).exitCode,
              1);
    EXPECT_FALSE(std::filesystem::exists(path("x.ply")));
}

}  // namespace
