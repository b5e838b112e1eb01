#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <set>
#include <string>
#include <vector>

#include "coloured_wall.h"
#include "edited_options.h"
#include "observations.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

// A map saved by a release must load for ever and give the answers noted beside it: the
// number of components, then lines "x y z log-density", and from version 1 on, which has
// free space, "P(occ) P(free)" behind them, and from version 2 on, which has modalities,
// the means of r, g and b. To write those of today's version anew, before it was released
// only, run these tests with HGMM_WRITE_GOLDEN=1.
const std::string kData = HGMM_TEST_DATA "/";

CHGMMOccupancyMap load(const std::string& name) {
    CHGMMOccupancyMap map;
    EXPECT_NO_THROW(map.loadFromFile(kData + name));
    return map;
}

/// A point beside each of some twenty surface components, and one half way to its sensor.
std::vector<Eigen::Vector3d> pointsOf(const hgmm::Map& map) {
    std::vector<Eigen::Vector3d> points;
    const auto& mixture = map.mixture();
    for (std::size_t i = 0; i < mixture.size(); i += 1 + mixture.size() / 20) {
        const hgmm::ViewDirection view = map.viewDirections()[i];
        points.push_back(map.origin() + mixture[i].mean +
                         Eigen::Vector3d(0.005, -0.005, 0.005));
        points.push_back(points.back() + 0.5 * view.range_m * view.direction);
    }
    return points;
}

const char* const kColours[] = {"r", "g", "b"};

/// Likelihood and render options of the files.
void changeAsInFiles(CHGMMOccupancyMap::TLikelihoodOptions& o) {
    o.kernelWidth_m = 0.2345;
    o.outlierRatio = 0.123;
    o.maxPoints = 77;
    o.independentPoints = 66;
    o.minRange_m = 0.45;
    o.maxRange_m = 33.3;
}
void changeAsInFiles(CHGMMOccupancyMap::TRenderOptions& o) {
    o.sigmas = 1.25;
    o.level = 2;
    o.maxEllipsoids = 55;
    o.colour = 1;
    o.modality = "water content";
    o.drawEllipsoids = false;
    o.drawFreeSpace = true;
    o.drawVoxels = true;
    o.voxelResolution_m = 0.25;
    o.minOccupied = 0.625;
    o.generateOccupiedVoxels = false;
    o.visibleOccupiedVoxels = false;
    o.generateFreeVoxels = false;
    o.visibleFreeVoxels = false;
    o.generateGridLines = true;
}
void changeAsInFiles(CHGMMOccupancyMap& map) {
    edited::change(map);
    changeAsInFiles(map.likelihoodOptions);
    changeAsInFiles(map.renderOptions);
}

void writeGolden(const CHGMMOccupancyMap& map, const std::string& name) {
    map.saveToFile(kData + name + ".hgmm");
    const CHGMMOccupancyMap saved = load(name + ".hgmm");
    const hgmm::Map& model = saved.model();
    std::ofstream answers(kData + name + ".txt");
    answers << model.mixture().size() << "\n" << std::setprecision(17);
    for (const Eigen::Vector3d& p : pointsOf(model)) {
        const hgmm::Occupancy occupancy = model.occupancy(p);
        answers << p.x() << " " << p.y() << " " << p.z() << " " << model.logDensity(p)
                << " " << occupancy.occupied << " " << occupancy.free;
        if (!model.params().modalities.empty())
            for (const char* colour : kColours)
                answers << " " << model.modality(colour, p).mean;
        answers << "\n";
    }
}

void writeGoldenWithColours() {
    CHGMMOccupancyMap map;
    map.insertionOptions.params.modalities = {"r", "g", "b"};
    map.insertObservation(*observations::laser(), CPose3D(10, -5, 0.3, 0.2, 0, 0));
    map.insertObservation(*observations::rotating(16, 91), CPose3D(10, -5, 0.3, 0.2, 0, 0));
    map.insertObservation(*coloured_wall::colours(), CPose3D(12, -5, 0.3, 1.2, 0, 0));
    changeAsInFiles(map);
    writeGolden(map, "map_model_v4");
}

/// A doorway |y| < .5 m, |z| < 1 m in a wall x = 4 m, shut or open, and a wall x = 7 m
/// behind it; with what passes for noise.
hgmm::Scan scanOfDoorway(bool isOpen, int index) {
    hgmm::Scan scan;
    for (int row = -15; row <= 15; ++row)
        for (int column = -45; column <= 45; ++column) {
            const float y = 0.02F * float(column), z = 0.02F * float(row);
            const bool passes = isOpen && std::abs(4 * y) < 0.5F && std::abs(4 * z) < 1;
            const float depth =
                (passes ? 7.0F : 4.0F) +
                0.02F * std::sin(float(97 * row + 31 * column + 13 * index));
            scan.pushBack(depth, depth * y, depth * z);
        }
    return scan;
}

void writeGoldenWithOpenings() {
    CHGMMOccupancyMap map;
    for (int i = 0; i < 40; ++i) map.model().insert(scanOfDoorway(i >= 37, i));
    writeGolden(map, "map_model_v5");
}

/// Lines of numbers behind the number of components, which is checked.
std::vector<std::vector<double>> readAnswers(const std::string& name,
                                             const hgmm::Map& map) {
    std::ifstream file(kData + name);
    std::size_t components = 0;
    EXPECT_TRUE(file >> components) << name;
    EXPECT_EQ(map.mixture().size(), components);
    EXPECT_NO_THROW(map.mixture().check());
    std::vector<std::vector<double>> answers;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        // strtod reads "-inf", which a stream does not.
        std::vector<double>& numbers = answers.emplace_back();
        char* end = line.data();
        for (const char* at = end; numbers.push_back(std::strtod(at, &end)), end != at;)
            at = end;
        numbers.pop_back();
    }
    return answers;
}

void expectLogDensity(const hgmm::Map& map, const std::vector<double>& answer) {
    const double got = map.logDensity({answer[0], answer[1], answer[2]});
    if (std::isinf(answer[3]))
        EXPECT_EQ(got, answer[3]);
    else
        EXPECT_NEAR(got, answer[3], 1e-4 * std::abs(answer[3]) + 1e-4);
}

/// Before there was a limit to independent points, all of them counted. Others that the
/// files do not hold have their defaults.
void forgetYoungOptions(CHGMMOccupancyMap& map) {
    map.likelihoodOptions.independentPoints = hgmm::mrpt_bridge::kMaxPoints;
    map.insertionOptions.params.novelty.maxThickness = hgmm::NoveltyParams().maxThickness;
    map.insertionOptions.reading = {};
    map.insertionOptions.params.occupancy.coverage = {};
    // Of defaults when the files were written: .4, 64 and .25.
    map.insertionOptions.params.occupancy.freeSpace.freeSettledScans = 56;
    map.insertionOptions.params.carving.carvedSupport = 0.21875;
    map.insertionOptions.params.occupancy.freeSpace.freeCellAtOneMetre_m = 0.875 * 0.4;
}

TEST(GoldenFile, MapOfVersion0LoadsAndAnswersAsEver) {
    const CHGMMOccupancyMap map = load("map_v0.hgmm");
    const auto answers = readAnswers("map_v0.txt", map.model());
    EXPECT_GE(answers.size(), 3U);
    for (const auto& answer : answers) {
        ASSERT_EQ(answer.size(), 4U);
        expectLogDensity(map.model(), answer);
    }

    CHGMMOccupancyMap wanted;
    changeAsInFiles(wanted.likelihoodOptions);
    forgetYoungOptions(wanted);
    EXPECT_EQ(edited::values(map.likelihoodOptions),
              edited::values(wanted.likelihoodOptions));
    // Version 0 had four render options; the others keep their defaults.
    auto& render = wanted.renderOptions;
    CHGMMOccupancyMap changed;
    changeAsInFiles(changed.renderOptions);
    render.level = changed.renderOptions.level;
    render.sigmas = changed.renderOptions.sigmas;
    render.maxEllipsoids = changed.renderOptions.maxEllipsoids;
    render.colour = changed.renderOptions.colour;
    EXPECT_EQ(edited::values(map.renderOptions), edited::values(render));
}

// It has no free space and no views, so that a new scan must bring both.
TEST(GoldenFile, MapOfVersion0GoesOn) {
    CHGMMOccupancyMap map = load("map_v0.hgmm");
    EXPECT_TRUE(map.model().freeMixture().empty());
    ASSERT_TRUE(
        map.insertObservation(*observations::laser(), CPose3D(10, -5, 0.3, 0.2, 0, 0)));
    EXPECT_NO_THROW(map.model().mixture().check());
    EXPECT_FALSE(map.model().freeMixture().empty());
}

/// Files without coverage get a guess of it: what was free is, but not as much.
constexpr double kGuessed = 0.05, kExact = 1e-3;

/// Log-densities and occupancies, of which some must be occupied and some free.
void expectOccupancies(const hgmm::Map& map,
                       const std::vector<std::vector<double>>& answers, double tolerance) {
    int occupied = 0, free = 0;
    for (const auto& answer : answers) {
        ASSERT_GE(answer.size(), 6U);
        expectLogDensity(map, answer);
        const hgmm::Occupancy got = map.occupancy({answer[0], answer[1], answer[2]});
        EXPECT_NEAR(got.occupied, answer[4], tolerance);
        if (tolerance < 0.01) {
            EXPECT_NEAR(got.free, answer[5], tolerance);
        }
        if (answer[5] > 0.9) {
            EXPECT_GT(got.free, 0.5);
        }
        occupied += answer[4] > 0.5 ? 1 : 0;
        free += answer[5] > 0.5 ? 1 : 0;
    }
    EXPECT_GE(occupied, 5);
    EXPECT_GE(free, 5);
}

TEST(GoldenFile, MapOfVersion1LoadsAndAnswersAsEver) {
    const CHGMMOccupancyMap map = load("map_v1.hgmm");
    expectOccupancies(map.model(), readAnswers("map_v1.txt", map.model()), kGuessed);

    CHGMMOccupancyMap wanted;
    // Of the defaults when the file was written; later ones do not change it.
    wanted.insertionOptions.params.occupancy.band.freeShare = 0.5;
    changeAsInFiles(wanted);
    // Version 1 had no modalities.
    wanted.insertionOptions.params.modalities.clear();
    wanted.insertionOptions.params.modality = hgmm::ModalityParams();
    wanted.renderOptions.modality.clear();
    forgetYoungOptions(wanted);
    EXPECT_EQ(edited::all(map), edited::all(wanted));
}

/// A map with modalities, and its answers.
void expectColouredMap(const CHGMMOccupancyMap& map, const std::string& answersName,
                       double tolerance) {
    const auto answers = readAnswers(answersName, map.model());
    expectOccupancies(map.model(), answers, tolerance);
    std::set<double> reds;
    for (const auto& answer : answers) {
        ASSERT_EQ(answer.size(), 9U);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(
                map.model().modality(kColours[c], {answer[0], answer[1], answer[2]}).mean,
                answer[6 + c], 1e-3);
        reds.insert(answer[6]);
    }
    EXPECT_GE(reds.size(), 3U);
}

TEST(GoldenFile, MapOfVersion2LoadsAndAnswersAsEver) {
    const CHGMMOccupancyMap map = load("map_v2.hgmm");
    expectColouredMap(map, "map_v2.txt", kGuessed);

    CHGMMOccupancyMap wanted;
    changeAsInFiles(wanted);
    forgetYoungOptions(wanted);
    EXPECT_EQ(edited::all(map), edited::all(wanted));
}

// The model has its own version, 4 with coverage, in an object of version 2.
TEST(GoldenFile, MapOfModelVersion4LoadsAndAnswersAsEver) {
    if (std::getenv("HGMM_WRITE_GOLDEN")) writeGoldenWithColours();
    const CHGMMOccupancyMap map = load("map_model_v4.hgmm");
    expectColouredMap(map, "map_model_v4.txt", kExact);
    EXPECT_GT(map.model().coverageBytes(), 100U);

    CHGMMOccupancyMap wanted;
    changeAsInFiles(wanted);
    wanted.insertionOptions.reading = map.insertionOptions.reading;
    EXPECT_EQ(edited::all(map), edited::all(wanted));
}

// Version 5 has openings.
TEST(GoldenFile, MapOfModelVersion5LoadsAndItsDoorIsOpen) {
    if (std::getenv("HGMM_WRITE_GOLDEN")) writeGoldenWithOpenings();
    CHGMMOccupancyMap map = load("map_model_v5.hgmm");
    expectOccupancies(map.model(), readAnswers("map_model_v5.txt", map.model()), kExact);
    EXPECT_EQ(map.model().save(hgmm::Encoding::compact)[4], 5);
    EXPECT_GT(map.model().occupancy({4.0, 0.0, 0.0}).free, 0.9F);
    EXPECT_GT(map.model().occupancy({4.0, 0.7, 0.0}).occupied, 0.9F);

    for (int i = 0; i < 2; ++i) map.model().insert(scanOfDoorway(false, i));
    EXPECT_GT(map.model().occupancy({4.0, 0.0, 0.0}).occupied, 0.5F);
}

}  // namespace
