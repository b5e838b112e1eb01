#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "replay_map_fixture.h"

namespace {

/// Study incremental: the map against mixtures fitted to all scans at once.
class ReplayIncremental : public ReplayFolder {
 protected:
    struct Model {
        std::string name;
        double components = 0, logLikelihood = 0, difference = 0;
    };

    /// The rows of incremental.csv.
    std::vector<Model> models(const std::string& folder) const {
        std::istringstream csv(content(folder + "/incremental.csv"));
        std::string line;
        std::getline(csv, line);
        EXPECT_EQ(line, "model,components,loglik_hit_nat,over_incremental_nat");
        std::vector<Model> rows;
        while (std::getline(csv, line)) {
            Model& row = rows.emplace_back();
            row.name = line.substr(0, line.find(','));
            EXPECT_EQ(std::sscanf(line.c_str() + row.name.size(), ",%lf,%lf,%lf",
                                  &row.components, &row.logLikelihood, &row.difference),
                      3)
                << line;
        }
        return rows;
    }

    /// Three models of nearly one size, the first being the map; differences add up.
    static void expectComparable(const std::vector<Model>& rows) {
        ASSERT_EQ(rows.size(), 3U);
        EXPECT_EQ(rows[0].name, "incremental map");
        EXPECT_EQ(rows[0].difference, 0.0);
        for (const Model& row : rows) {
            EXPECT_LE(row.components, rows[0].components) << row.name;
            EXPECT_GE(row.components, 0.95 * rows[0].components) << row.name;
            EXPECT_NEAR(row.difference, row.logLikelihood - rows[0].logLikelihood, 1e-4);
        }
    }

    static double betterBatch(const std::vector<Model>& rows) {
        return std::max(rows[1].difference, rows[2].difference);
    }
};

}  // namespace

TEST_F(ReplayIncremental, IsListed) {
    expectHas(replay("--list-studies").out, "incremental");
}

TEST_F(ReplayIncremental, MapOfABoxRoomIsNearlyAsGoodAsBatchModels) {
    const std::string room = recordRoom(24, 6000);
    const Outcome outcome =
        replay(room + " --split 4 --study incremental --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "18 scans mapped, 6 tested, 12000 held-out hits");
    expectHas(outcome.out, "batch EM from cells");
    const std::vector<Model> rows = models("report");
    expectComparable(rows);
    EXPECT_LT(betterBatch(rows), 0.3) << outcome.out;
    // Batch models of other points, or in another frame, would be far worse than the map.
    EXPECT_GT(rows[1].difference, -0.3);
    EXPECT_GT(rows[2].difference, -0.1);

    // The map in the table is the map of a plain replay.
    ASSERT_EQ(replay(room + " --split 4 --report " + path("plain")).exitCode, 0);
    const auto map = metrics("plain")["maps"][0];
    EXPECT_EQ(map["components_surface"], rows[0].components);
    // But for rounding: its figures are those of the saved map.
    EXPECT_NEAR(map["loglik_hit"], rows[0].logLikelihood, 5e-3);
}

TEST_F(ReplayIncremental, DoesNotDependOnTheNumberOfThreads) {
    const std::string command =
        recordRoom(6) + " --holdout-points 0.1 --study incremental --quiet --threads ";
    const Outcome one = replay(command + "1");
    ASSERT_EQ(one.exitCode, 0) << one.err;
    EXPECT_EQ(one.err, "");
    EXPECT_EQ(one.out, replay(command + "2").out);
}

TEST_F(ReplayIncremental, NeedsTestPoints) {
    const std::string room = recordRoom(3);
    const Outcome unasked = replay(room + " --study incremental");
    EXPECT_EQ(unasked.exitCode, 2);
    expectHas(unasked.err, "--split K");
    const Outcome none = replay(room + " --split 100 --study incremental");
    EXPECT_EQ(none.exitCode, 1);
    expectHas(none.err, "no test points");
}

TEST_F(ReplayIncremental, NeedsPoses) {
    box_room::writeRawlog(path("room.rawlog"), box_room::observations(3, 500));
    const Outcome outcome =
        replay("'" + path("room.rawlog") + "' --split 2 --study incremental");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "poses");
}

TEST_F(ReplayIncremental, KitchenIsWithin015NatOfTheBetterBatchModel) {
    const char* data = std::getenv("HGMM_DATA_DIR");
    if (!data) GTEST_SKIP() << "SKIPPED: HGMM_DATA_DIR is not set";
    const Outcome imported =
        run("hgmm-import", "7scenes '" + std::filesystem::absolute(data).string() +
                               "/rgbd_kitchen' -o '" + path("kitchen.rawlog") +
                               "' --poses-out '" + path("kitchen.tum") + "'");
    ASSERT_EQ(imported.exitCode, 0) << imported.err;
    const Outcome outcome =
        replay("'" + path("kitchen.rawlog") + "' --poses '" + path("kitchen.tum") +
               "' --split 10 --study incremental --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::vector<Model> rows = models("report");
    expectComparable(rows);
    EXPECT_LE(betterBatch(rows), 0.15) << outcome.out;
}
