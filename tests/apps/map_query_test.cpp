#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "replay_map_fixture.h"

namespace {

/// hgmm-map query on a saved map of the box room.
class MapQuery : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        for (std::size_t i = 0; i < 8; ++i) {
            const auto pose = box_room::robotPose(i);
            map_.insertObservation(
                *box_room::pointCloud(pose, box_room::timeOfScan(i), 4000), pose);
        }
        map_.saveToFile(path("m.hgmm"));
        // What was saved is not quite what was made.
        map_.loadFromFile(path("m.hgmm"));
    }

    Outcome query(const std::string& arguments) const {
        return mapTool("query " + path("m.hgmm") + " " + arguments);
    }

    /// Rows of a CSV by the names of its columns.
    static std::vector<std::map<std::string, std::string>> rowsOf(const std::string& csv) {
        std::vector<std::map<std::string, std::string>> rows;
        std::vector<std::string> names;
        std::istringstream in(csv);
        for (std::string line; std::getline(in, line);) {
            std::vector<std::string> fields(1);
            for (const char c : line)
                if (c == ',')
                    fields.emplace_back();
                else
                    fields.back() += c;
            if (names.empty()) {
                names = fields;
                continue;
            }
            EXPECT_EQ(fields.size(), names.size()) << line;
            rows.emplace_back();
            for (std::size_t i = 0; i < names.size(); ++i)
                rows.back()[names[i]] = fields.at(i);
        }
        return rows;
    }

    void expectRefused(const std::string& text, const std::string& said) const {
        std::ofstream(path("bad.csv")) << text;
        const Outcome outcome = query("--points " + path("bad.csv"));
        EXPECT_EQ(outcome.exitCode, 1) << text;
        expectHas(outcome.err, said);
        EXPECT_EQ(outcome.out, "");
    }

    mrpt::maps::CHGMMOccupancyMap map_;
};

TEST_F(MapQuery, CsvHoldsTheAnswersOfTheMapExactly) {
    std::ofstream(path("in.csv")) << "\xEF\xBB\xBFname,z,\"y\",x\r\n"
                                     "\"a, \"\"b\"\"\",0.2,0.5,4\r\n"
                                     "\n"
                                     "# a comment\n"
                                     "c,0.1,-1.0000000000000002,1.5\n"
                                     "far,0,0,900\n";
    const Outcome outcome =
        query("--distance --points " + path("in.csv") + " --out " + path("out.csv"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const auto rows = rowsOf(content("out.csv"));
    const Eigen::Vector3d points[] = {
        {4, 0.5, 0.2}, {1.5, -1.0000000000000002, 0.1}, {900, 0, 0}};
    ASSERT_EQ(rows.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto number = [&](const char* name) {
            return std::strtod(rows[i].at(name).c_str(), nullptr);
        };
        const hgmm::Occupancy o = map_.model().occupancy(points[i]);
        EXPECT_EQ(number("x"), points[i].x());
        EXPECT_EQ(number("y"), points[i].y());
        EXPECT_EQ(number("z"), points[i].z());
        EXPECT_EQ(float(number("p_occ")), o.occupied);
        EXPECT_EQ(float(number("p_free")), o.free);
        EXPECT_EQ(float(number("p_unknown")), o.unknown);
        EXPECT_EQ(rows[i].at("known"), o.unknown <= 0.5F ? "1" : "0");
        const hgmm::SurfaceDistance s = map_.model().distance(points[i]);
        EXPECT_EQ(rows[i].at("distance_known"), s.known ? "1" : "0");
        if (!s.answered()) continue;
        EXPECT_EQ(float(number("along_ray_m")), o.alongRay_m);
        EXPECT_EQ(number("distance_m"), s.distance_m);
        EXPECT_EQ(number("gradient_x"), s.gradient.x());
        EXPECT_EQ(number("gradient_y"), s.gradient.y());
        EXPECT_EQ(number("gradient_z"), s.gradient.z());
        EXPECT_EQ(number("distance_std_m"), s.std_m);
    }
    EXPECT_EQ(rows[2].at("distance_m"), "") << "nothing within 5 m";
    EXPECT_EQ(rows[2].at("along_ray_m"), "");
    EXPECT_EQ(rows[0].count("distance_std_m"), 1U);
}

TEST_F(MapQuery, JsonLinesAreTheCsv) {
    const std::string points = "4,0.5,0.2 1.5,-1,0.1 900,0,0 --distance";
    ASSERT_EQ(query(points + " --out " + path("out.csv")).exitCode, 0);
    const auto rows = rowsOf(content("out.csv"));
    const Outcome outcome = query(points + " --json");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    std::istringstream lines(outcome.out);
    std::size_t i = 0;
    for (std::string line; std::getline(lines, line); ++i) {
        const auto object = nlohmann::json::parse(line);
        ASSERT_LT(i, rows.size());
        ASSERT_EQ(object.size(), rows[i].size());
        for (const auto& [name, text] : rows[i]) {
            const auto& value = object.at(name);
            if (value.is_null())
                EXPECT_EQ(text, "") << name;
            else if (value.is_boolean())
                EXPECT_EQ(text, value.get<bool>() ? "1" : "0") << name;
            else
                EXPECT_EQ(std::strtod(text.c_str(), nullptr), value.get<double>()) << name;
        }
    }
    EXPECT_EQ(i, 3U);
    ASSERT_EQ(query(points + " --json --out " + path("out.json")).exitCode, 0);
    EXPECT_EQ(content("out.json"), outcome.out);
}

TEST_F(MapQuery, AnswersOfNoPointsHaveAHeader) {
    std::ofstream(path("none.csv")) << "x,y,z\n";
    const std::string points = "--distance --points " + path("none.csv");
    ASSERT_EQ(query(points + " --out " + path("out.csv")).exitCode, 0);
    expectHas(content("out.csv"), "x,y,z,p_occ,p_free,p_unknown,known");
    expectHas(content("out.csv"), ",distance_m,gradient_x,");
    EXPECT_EQ(rowsOf(content("out.csv")).size(), 0U);
}

TEST_F(MapQuery, ListingHasTheDistanceWhereItIsAskedFor) {
    const Outcome plain = query("1.5,-1,0.3"), longer = query("1.5,-1,0.3 --distance"),
                  near = query("1.5,-1,0.3 --distance --max-distance 0.01");
    ASSERT_EQ(longer.exitCode, 0) << longer.err;
    const std::string row = plain.out.substr(plain.out.find('\n') + 1);
    expectHas(longer.out, "\n" + row.substr(0, row.size() - 1) + " ");
    expectHas(near.out, " - - - - -\n");
    EXPECT_EQ(query("1,1,1 --distance --max-distance 0").exitCode, 2);
}

TEST_F(MapQuery, NamesTheLinesOfBadRows) {
    expectRefused("x,y\n1,2\n", "bad.csv:1: needs one column z");
    expectRefused("x,y,z,x\n1,2,3,4\n", "bad.csv:1: needs one column x");
    expectRefused("x,y,z\n1,2,3\n1,2\n", "bad.csv:3: has 2 fields, the header 3");
    expectRefused("x,y,z\n\n1,two,3\n", "bad.csv:3: 'two' is not a finite number");
    expectRefused("x,y,z\n1,nan,3\n", "bad.csv:2: 'nan' is not a finite number");
    expectRefused("x,y,z\n1,,3\n", "bad.csv:2: must be three numbers");
    expectRefused("x,y,z,n\n1,2,3,\"a\n", "bad.csv:2: a quote is not closed");
    const Outcome outcome = query("1,2,3 --out " + path("no/such/folder.csv"));
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "folder.csv");
}

}  // namespace
