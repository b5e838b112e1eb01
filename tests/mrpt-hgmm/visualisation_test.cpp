#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/opengl/CEllipsoid3D.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <set>

#include "observations.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::opengl::CEllipsoid3D;
using mrpt::opengl::CSetOfObjects;

namespace {

CHGMMOccupancyMap wallMap() {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::cloud(),
                          mrpt::poses::CPose3D(200, 0, 1, 0.3, 0, 0));
    map.insertObservation(*observations::rotating(16),
                          mrpt::poses::CPose3D(230, 0, 2, 0, 0, 0));
    EXPECT_GT(map.model().mixture().size(), 5U);
    return map;
}

CEllipsoid3D::Ptr ellipsoidAt(const CSetOfObjects& objects, std::size_t i) {
    auto it = objects.begin();
    std::advance(it, i);
    return std::dynamic_pointer_cast<CEllipsoid3D>(*it);
}

std::size_t count(const CHGMMOccupancyMap& map) {
    return map.getVisualization()->size();
}

TEST(Visualisation, OneEllipsoidPerComponentInTheMapFrame) {
    const CHGMMOccupancyMap map = wallMap();
    CSetOfObjects objects;
    objects.insert(CEllipsoid3D::Create());
    map.getVisualizationInto(objects);
    const auto& mixture = map.model().mixture();
    ASSERT_EQ(objects.size(), mixture.size() + 1) << "appended to what was there";
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const auto shape = ellipsoidAt(objects, i + 1);
        ASSERT_TRUE(shape);
        const auto g = mixture[i];
        EXPECT_NEAR(shape->getPose().x, map.model().origin().x() + g.mean[0], 1e-6);
        EXPECT_NEAR(shape->getPose().z, map.model().origin().z() + g.mean[2], 1e-6);
        EXPECT_EQ(shape->getCovMatrix()(0, 1), g.covariance(0, 1));
        EXPECT_FLOAT_EQ(shape->getQuantiles(), 2.F);
    }
}

TEST(Visualisation, ObeysItsOptions) {
    CHGMMOccupancyMap map = wallMap();
    const std::size_t all = count(map);
    map.renderOptions.maxEllipsoids = 3;
    EXPECT_EQ(count(map), 3U);
    float heaviest = 0, smallestDrawn = 1e9F;
    for (const float s : map.model().mixture().support) heaviest = std::max(heaviest, s);
    map.renderOptions.maxEllipsoids = 1;
    const auto shape = ellipsoidAt(*map.getVisualization(), 0);
    for (std::size_t i = 0; i < all; ++i)
        if (std::abs(shape->getPose().x - map.model().origin().x() -
                     map.model().mixture().mean[0][i]) < 1e-6)
            smallestDrawn = std::min(smallestDrawn, map.model().mixture().support[i]);
    EXPECT_EQ(smallestDrawn, heaviest);

    map.renderOptions = CHGMMOccupancyMap::TRenderOptions();
    map.renderOptions.level = 2;
    EXPECT_EQ(count(map), map.model().mixture(2).size());
    map.renderOptions.level = 999;  // the coarsest
    EXPECT_EQ(count(map), map.model().mixture(map.model().levelCount() - 1).size());
    map.genericMapParams.enableSaveAs3DObject = false;
    EXPECT_EQ(count(map), 0U);
}

std::vector<int> colours(const CHGMMOccupancyMap& map) {
    std::vector<int> result;
    const auto objects = map.getVisualization();
    for (const auto& o : *objects) {
        const auto c = o->getColor_u8();
        result.push_back((c.R << 16) | (c.G << 8) | c.B);
    }
    return result;
}

TEST(Visualisation, ColourShowsWhatTheOptionSays) {
    CHGMMOccupancyMap map = wallMap();
    std::set<std::vector<int>> all;
    for (const int colour : {0, 1, 2, 3}) {
        map.renderOptions.colour = colour;
        const auto shown = colours(map);
        EXPECT_TRUE(all.insert(shown).second) << colour << ": as another option";
        if (colour < 2) {
            EXPECT_GT(std::set<int>(shown.begin(), shown.end()).size(), 1U) << colour;
        }
    }
}

// Blue at 0, red at 1, whatever the other components are.
TEST(Visualisation, OccupancyColoursAreAbsolute) {
    CHGMMOccupancyMap map = wallMap();
    map.renderOptions.colour = 2;
    const auto objects = map.getVisualization();
    const auto& mixture = map.model().mixture();
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const double occupied =
            map.model().occupancy(map.model().origin() + mixture[i].mean).occupied;
        const auto colour = ellipsoidAt(*objects, i)->getColor_u8();
        if (occupied > 0.7) {
            EXPECT_GT(colour.R, colour.B) << i;
        } else if (occupied < 0.3) {
            EXPECT_LT(colour.R, colour.B) << i;
        }
    }
}

TEST(Visualisation, FreeSpaceIsTranslucentAndOptional) {
    CHGMMOccupancyMap map = wallMap();
    map.renderOptions.drawFreeSpace = true;
    map.renderOptions.drawEllipsoids = false;
    const auto& mixture = map.model().freeMixture();
    ASSERT_GT(mixture.size(), 0U);
    const auto objects = map.getVisualization();
    ASSERT_EQ(objects->size(), mixture.size());
    const auto shape = ellipsoidAt(*objects, 0);
    ASSERT_TRUE(shape);
    EXPECT_LT(shape->getColor().A, 0.5F);
    EXPECT_NEAR(shape->getPose().x, map.model().origin().x() + mixture.mean[0][0], 1e-6);
    EXPECT_EQ(shape->getCovMatrix()(1, 2), mixture[0].covariance(1, 2));
}

TEST(Visualisation, EmptyMapDrawsNothing) {
    EXPECT_EQ(count(CHGMMOccupancyMap()), 0U);
}

}  // namespace
