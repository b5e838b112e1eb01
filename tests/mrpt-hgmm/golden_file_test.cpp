#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstdlib>
#include <fstream>
#include <iomanip>

#include "edited_options.h"
#include "observations.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

// A map saved by the first release must load for ever and give the answers noted beside it:
// the number of components, then lines "x y z log-density". To write both anew, before a
// first release only, run this test with HGMM_WRITE_GOLDEN=1.
const std::string kMap = HGMM_TEST_DATA "/map_v0.hgmm";
const std::string kAnswers = HGMM_TEST_DATA "/map_v0.txt";

void writeGolden() {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::laser(), CPose3D(10, -5, 0.3, 0.2, 0, 0));
    map.insertObservation(*observations::rotating(16, 91), CPose3D(10, -5, 0.3, 0.2, 0, 0));
    map.insertObservation(*observations::cloud(), CPose3D(12, -5, 0.3, 1.2, 0, 0));
    edited::change(map.likelihoodOptions);
    edited::change(map.renderOptions);
    map.saveToFile(kMap);
    std::ofstream answers(kAnswers);
    const auto& mixture = map.model().mixture();
    answers << mixture.size() << "\n" << std::setprecision(17);
    for (std::size_t i = 0; i < mixture.size(); i += 1 + mixture.size() / 20) {
        const Eigen::Vector3d p = map.model().origin() + mixture[i].mean.cast<double>() +
                                  Eigen::Vector3d(0.005, -0.005, 0.005);
        answers << p.x() << " " << p.y() << " " << p.z() << " " << map.model().logDensity(p)
                << "\n";
    }
}

TEST(GoldenFile, MapOfVersion0LoadsAndAnswersAsEver) {
    if (std::getenv("HGMM_WRITE_GOLDEN")) writeGolden();
    CHGMMOccupancyMap map;
    ASSERT_NO_THROW(map.loadFromFile(kMap));
    std::ifstream answers(kAnswers);
    std::size_t components = 0;
    ASSERT_TRUE(answers >> components) << kAnswers;
    EXPECT_EQ(map.model().mixture().size(), components);
    EXPECT_NO_THROW(map.model().mixture().check());
    int points = 0;
    for (double x, y, z, expected; answers >> x >> y >> z >> expected; ++points)
        EXPECT_NEAR(map.model().logDensity({x, y, z}), expected,
                    1e-4 * std::abs(expected) + 1e-4)
            << x << " " << y << " " << z;
    EXPECT_GE(points, 3);

    CHGMMOccupancyMap wanted;
    edited::change(wanted.likelihoodOptions);
    edited::change(wanted.renderOptions);
    EXPECT_EQ(edited::values(map.likelihoodOptions),
              edited::values(wanted.likelihoodOptions));
    EXPECT_EQ(edited::values(map.renderOptions), edited::values(wanted.renderOptions));
}

}  // namespace
