#include <sstream>
#include <vector>

#include "replay_map_fixture.h"

using ReplayStudy = ReplayFolder;

TEST_F(ReplayStudy, StudiesAreListed) {
    Outcome outcome = replay("--list-studies");
    EXPECT_EQ(outcome.exitCode, 0);
    outcome.out.insert(0, "\n");
    for (const char* name :
         {"fig3.2", "fig3.5", "fig3.8", "incremental", "fig4.1", "fig4.2", "table4.1",
          "fig4.5", "realtime", "free-space", "room", "dynamics", "unseen"})
        expectHas(outcome.out, std::string("\n") + name + " ");
}

TEST_F(ReplayStudy, Fig32ReducesEachFrameFromAboutThreeHundred) {
    box_room::writeRawlog(path("room.rawlog"), box_room::observations(3, 20000));
    // No poses: each frame stands for itself.
    const Outcome outcome =
        replay("'" + path("room.rawlog") + "' --study fig3.2 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "3 frames (0 left out)");
    std::istringstream csv(content("report/fig3.2.csv"));
    std::string line;
    ASSERT_TRUE(std::getline(csv, line));
    expectHas(line, "frame,components,similarity_nat,kl_nat,cauchy_schwarz_nat");
    int rows = 0, knees = 0, lastFrame = -1;
    double lastSize = 0;
    while (std::getline(csv, line)) {
        int frame = 0, isKnee = 0;
        double size = 0, similarity = 0, kl = 0, cs = 0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%d,%lf,%lf,%lf,%lf,%d", &frame, &size,
                              &similarity, &kl, &cs, &isKnee),
                  6)
            << line;
        if (frame != lastFrame) {
            EXPECT_NEAR(size, 300, 30);
            EXPECT_NEAR(cs, 0.0, 1e-6);
        } else {
            EXPECT_LE(size, lastSize);
        }
        EXPECT_GE(cs, -1e-9);
        lastFrame = frame;
        lastSize = size;
        knees += isKnee;
        ++rows;
    }
    EXPECT_GT(rows, 9);
    EXPECT_EQ(knees, 3);
    const nlohmann::json plots = metrics("report")["plots"];
    ASSERT_EQ(plots.size(), 2U);
    for (const auto& plot : plots) {
        expectHas(plot["x_label"], "components");
        expectHas(plot["y_label"], "[nat]");
        EXPECT_EQ(plot["curves"].size(), 4U) << "three frames and their mean";
    }
}

TEST_F(ReplayStudy, ScansTooSparseForItAreSaidSo) {
    box_room::writeRawlog(path("room.rawlog"), box_room::observations(2, 50));
    const Outcome outcome = replay("'" + path("room.rawlog") + "' --study fig3.2");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "fig3.2");
}
