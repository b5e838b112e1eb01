#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/opengl/CEllipsoid3D.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <cmath>
#include <filesystem>

#include "coloured_wall.h"
#include "hgmm/mrpt_bridge/modality_colours.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observations.h"

using hgmm::mrpt_bridge::modalityColours;
using hgmm::mrpt_bridge::shownModalities;
using mrpt::img::TColorf;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::opengl::COctoMapVoxels;
using mrpt::opengl::VOXEL_SET_FREESPACE;
using mrpt::opengl::VOXEL_SET_OCCUPIED;

namespace {

using Names = std::vector<std::string>;
constexpr int kShowModality = 4;

void expectWall(const hgmm::Map& map) {
    for (const double y : {-0.8, -0.3, 0.3, 0.8})
        for (const double z : {-0.7, 0.0, 0.7}) {
            const Eigen::Vector3d truth = coloured_wall::colourAt(y, z);
            const char* names[] = {"r", "g", "b"};
            for (int c = 0; c < 3; ++c) {
                const auto answer = map.modality(names[c], coloured_wall::onWall(y, z));
                EXPECT_TRUE(answer.known) << y << ' ' << z;
                EXPECT_NEAR(answer.mean, truth[c], 0.04) << names[c] << y << ' ' << z;
            }
        }
}

TEST(ModalityMap, ObservationsFillTheModalitiesAskedFor) {
    expectWall(coloured_wall::map().model());
    const CHGMMOccupancyMap none = coloured_wall::map({});
    EXPECT_EQ(none.model().modality("r"), nullptr);
    EXPECT_GT(none.model().mixture().size(), 0U);
    const CHGMMOccupancyMap plain = coloured_wall::map({"intensity"});
    EXPECT_EQ(plain.model().modality("intensity"), nullptr) << "the sensor has none";

    CHGMMOccupancyMap bright = coloured_wall::map({"intensity"});
    bright.insertObservation(*coloured_wall::intensities(), coloured_wall::kSensor);
    EXPECT_NEAR(bright.model().modality("intensity", coloured_wall::onWall(0.5, 0)).mean,
                0.9, 0.03);
}

/// The wall with counts around 200, and a reflector of another count.
mrpt::obs::CObservationPointCloud::Ptr counts(float reflector) {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    int i = 0;
    coloured_wall::forEachPoint([&](float x, float y, float z) {
        const bool reflects = y > 0.9F && z > 0.9F;
        points->insertPointRGB(x, y, z, reflects ? reflector : 185.F + i++ % 30, 0, 0);
    });
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->pointcloud = points;
    return o;
}

TEST(ModalityMap, OneScaleOfIntensitiesServesAMap) {
    for (const float first : {200.F, 900.F}) {
        CHGMMOccupancyMap map = coloured_wall::map({"intensity"});
        map.clear();
        EXPECT_EQ(map.insertionOptions.reading.intensityScale, 0.0);
        for (int i = 0; i < 4; ++i)
            map.insertObservation(*counts(i % 2 == 0 ? first : 1100.F - first),
                                  coloured_wall::kSensor);
        const double scale = first > 255 ? 65535 : 255;
        EXPECT_EQ(map.insertionOptions.reading.intensityScale, scale);
        const auto answer = map.model().modality("intensity", coloured_wall::onWall(0, 0));
        EXPECT_NEAR(answer.mean, 200 / scale, 0.01) << first;
        EXPECT_LT(answer.variance, 0.002) << first;
    }
}

TEST(ModalityMap, AScanThatFitsAnyScaleTellsNone) {
    auto dark = mrpt::maps::CPointsMapXYZI::Create();
    for (const float value : {0.F, 1.F, std::nanf("")})
        dark->insertPointRGB(1, 2, 3, value, 0, 0);
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->pointcloud = dark;
    using hgmm::mrpt_bridge::intensityScaleOf;
    EXPECT_FALSE(intensityScaleOf(*o));
    EXPECT_FALSE(intensityScaleOf(*coloured_wall::colours()));
    dark->insertPointRGB(1, 2, 3, 0.5F, 0, 0);
    EXPECT_EQ(intensityScaleOf(*o), 1.0);
    dark->insertPointRGB(1, 2, 3, 255.F, 0, 0);
    EXPECT_EQ(intensityScaleOf(*o), 255.0);
    dark->insertPointRGB(1, 2, 3, 256.F, 0, 0);
    EXPECT_EQ(intensityScaleOf(*o), 65535.0);
}

TEST(ModalityMap, RgbIsReadInLettersOfAnyCase) {
    for (const std::string name : {"rgb", "RGB", "Rgb"}) {
        const mrpt::config::CConfigFileMemory config("[i]\nmodalities = " + name + "\n");
        CHGMMOccupancyMap::TInsertionOptions options;
        options.loadFromConfigFile(config, "i");
        EXPECT_EQ(options.params.modalities, (Names{"r", "g", "b"})) << name;
    }
}

TEST(ModalityMap, ConfigurationsNameThem) {
    const mrpt::config::CConfigFileMemory config(
        std::string("[m]\nhgmmMap_count = 1\n[m_hgmmMap_00_insertOpts]\n"
                    "modalities = rgb, intensity\n"));
    mrpt::maps::TSetOfMetricMapInitializers definitions;
    definitions.loadFromConfigFile(config, "m");
    mrpt::maps::CMultiMetricMap maps(definitions);
    maps.insertObservation(*coloured_wall::colours(), coloured_wall::kSensor);
    const auto map = maps.mapByClass<CHGMMOccupancyMap>();
    EXPECT_EQ(map->model().modalities(), (Names{"r", "g", "b", "intensity"}));
    expectWall(map->model());
}

// CMultiMetricMap copies through archives; files are compact.
TEST(ModalityMap, CopiesAndFilesKeepThem) {
    const auto map = CHGMMOccupancyMap::Create(coloured_wall::map());
    mrpt::maps::CMultiMetricMap original;
    original.maps.push_back(map);
    const mrpt::maps::CMultiMetricMap copy = original;
    EXPECT_EQ(copy.mapByClass<CHGMMOccupancyMap>()->model(), map->model());
    expectWall(copy.mapByClass<CHGMMOccupancyMap>()->model());

    const std::string file =
        (std::filesystem::path(::testing::TempDir()) / "hgmm_coloured.hgmm").string();
    map->saveToFile(file);
    CHGMMOccupancyMap loaded;
    loaded.loadFromFile(file);
    std::filesystem::remove(file);
    EXPECT_EQ(loaded.insertionOptions.params.modalities, (Names{"r", "g", "b"}));
    expectWall(loaded.model());
}

TEST(ModalityMap, ConfigurationsThatNameNoneKeepThoseOfTheLoadedFile) {
    const std::string file =
        (std::filesystem::path(::testing::TempDir()) / "hgmm_to_load.hgmm").string();
    coloured_wall::map().saveToFile(file);
    for (const auto& [line, expected] :
         {std::pair{"levels = 4", Names{"r", "g", "b"}},
          std::pair{"modalities = g, heat", Names{"g", "heat"}}}) {
        const mrpt::config::CConfigFileMemory config(
            "[m]\nhgmmMap_count = 1\n[m_hgmmMap_00_creationOpts]\nload_file = " + file +
            "\n[m_hgmmMap_00_insertOpts]\n" + line + "\n");
        mrpt::maps::TSetOfMetricMapInitializers definitions;
        definitions.loadFromConfigFile(config, "m");
        const mrpt::maps::CMultiMetricMap maps(definitions);
        const auto map = maps.mapByClass<CHGMMOccupancyMap>();
        EXPECT_EQ(map->model().modalities(), expected);
        EXPECT_EQ(map->insertionOptions.params.modalities, expected);
        EXPECT_NE(map->model().modality("g"), nullptr);
        EXPECT_EQ(map->model().modality("r") == nullptr, expected.size() == 2);
    }
    std::filesystem::remove(file);
}

/// Points that the colour camera does not see are no reason to forget the others.
TEST(ModalityMap, PointsWithoutColourAreLeftOutOfTheModalityOnly) {
    auto o = observations::depthImage();
    o->hasIntensityImage = true;
    o->intensityImage.resize(64, 48, mrpt::img::CH_GRAY);
    o->intensityImage.filledRectangle(0, 0, 63, 47, mrpt::img::TColor(102, 102, 102));
    o->cameraParamsIntensity = o->cameraParams;
    o->relativePoseIntensityWRTDepth =
        mrpt::poses::CPose3D(0, 0.5, 0, 0, 0, 0) + o->relativePoseIntensityWRTDepth;
    CHGMMOccupancyMap map;
    map.insertionOptions.params.modalities = {"intensity"};
    map.insertObservation(*o);
    const auto at = [&](int row, int col) {
        const double x = 0.001 * (2000 + 9 * col + 3 * row);
        return map.model().modality("intensity",
                                    {x, (31.0 - col) * x / 60, (25.0 - row) * x / 62});
    };
    EXPECT_TRUE(at(24, 20).known);
    EXPECT_NEAR(at(24, 20).mean, 0.4, 0.01);
    EXPECT_FALSE(at(24, 60).known) << "beyond the right edge of the image";
    CHGMMOccupancyMap plain;
    plain.insertObservation(*o);
    EXPECT_EQ(map.model().mixture(), plain.model().mixture()) << "surfaces do not depend";
}

TEST(ModalityColours, NamesAreChosenAsDocumented) {
    const hgmm::Map rgb = coloured_wall::map({"intensity", "b", "g", "r"}).model();
    EXPECT_EQ(shownModalities(rgb, ""), (Names{"r", "g", "b"}));
    EXPECT_EQ(shownModalities(rgb, "rgb"), (Names{"r", "g", "b"}));
    EXPECT_EQ(shownModalities(rgb, "intensity"), Names{"intensity"});
    EXPECT_EQ(shownModalities(rgb, "water"), Names());
    const hgmm::Map two = coloured_wall::map({"g", "r"}).model();
    EXPECT_EQ(shownModalities(two, ""), Names{"g"});
    EXPECT_EQ(shownModalities(two, "rgb"), Names());
    EXPECT_EQ(shownModalities(hgmm::Map(), ""), Names());
}

TEST(ModalityColours, PointsHaveTheColoursOfTheWallAndGreyBeyond) {
    const CHGMMOccupancyMap map = coloured_wall::map();
    const auto colours = modalityColours(
        map.model(), "",
        {coloured_wall::onWall(0.5, 0.2), coloured_wall::onWall(-0.5, -0.2), {0, 50, 0}});
    EXPECT_NEAR(colours[0].R, 0.9, 0.04);
    EXPECT_NEAR(colours[0].G, 0.34, 0.04);
    EXPECT_NEAR(colours[1].B, 0.8, 0.04);
    for (const float v : {colours[2].R, colours[2].G, colours[2].B}) EXPECT_EQ(v, 0.5F);
    const auto scale = modalityColours(
        map.model(), "g",
        {coloured_wall::onWall(0.5, -0.9), coloured_wall::onWall(0.5, 0.9)});
    EXPECT_GT(scale[0].B, scale[0].R) << "the lowest is blue";
    EXPECT_GT(scale[1].R, scale[1].B) << "the highest is red";
}

TEST(ModalityEllipsoids, AreThoseOfTheModalityInItsColours) {
    CHGMMOccupancyMap map = coloured_wall::map();
    map.renderOptions.colour = kShowModality;
    const auto objects = map.getVisualization();
    ASSERT_EQ(objects->size(), map.model().modality("r")->size());
    int left = 0, right = 0;
    for (const auto& object : *objects) {
        const auto shape = std::dynamic_pointer_cast<mrpt::opengl::CEllipsoid3D>(object);
        ASSERT_TRUE(shape);
        const auto colour = shape->getColor();
        EXPECT_NEAR(shape->getPose().x, 103, 0.05);
        if (std::abs(shape->getPose().y) < 0.1) continue;
        const Eigen::Vector3d truth =
            coloured_wall::colourAt(shape->getPose().y, shape->getPose().z - 1);
        EXPECT_NEAR(colour.R, truth[0], 0.05);
        EXPECT_NEAR(colour.G, truth[1], 0.05);
        EXPECT_NEAR(colour.B, truth[2], 0.05);
        (shape->getPose().y > 0 ? left : right) += 1;
    }
    EXPECT_GT(left, 0);
    EXPECT_GT(right, 0);

    map.renderOptions.modality = "water";
    EXPECT_EQ(map.getVisualization()->size(), map.model().mixture().size());
    const auto grey = (*map.getVisualization()->begin())->getColor();
    EXPECT_EQ(grey.R, grey.B) << "unknown modalities are grey";
}

TEST(ModalityVoxels, OccupiedOnesHaveTheColourOfTheSurfaceInThem) {
    CHGMMOccupancyMap map = coloured_wall::map();
    map.renderOptions.colour = kShowModality;
    map.renderOptions.voxelResolution_m = 0.1;
    COctoMapVoxels voxels;
    voxels.setVisualizationMode(COctoMapVoxels::FIXED);
    voxels.setColor(1.0, 0.5, 1.0, 0.7);
    map.getAsOctoMapVoxels(voxels);
    int compared = 0, grey = 0;
    for (std::size_t i = 0; i < voxels.getVoxelCount(VOXEL_SET_OCCUPIED); ++i) {
        const auto& voxel = voxels.getVoxel(VOXEL_SET_OCCUPIED, i);
        const double y = voxel.coords.y, z = voxel.coords.z - 1;
        if (std::abs(y) < 0.16 || std::abs(y) > 0.9 || std::abs(z) > 0.9) continue;
        ++compared;
        grey += voxel.color.R == voxel.color.B ? 1 : 0;
        const Eigen::Vector3d truth = coloured_wall::colourAt(y, z);
        EXPECT_NEAR(voxel.color.R, 255 * truth[0], 25) << y << ' ' << z;
        EXPECT_NEAR(voxel.color.G, 127 * truth[1], 25);
        EXPECT_NEAR(voxel.color.B, 255 * truth[2], 25);
        EXPECT_EQ(voxel.color.A, 178);
    }
    EXPECT_GT(compared, 150);
    EXPECT_EQ(grey, 0);
    ASSERT_GT(voxels.getVoxelCount(VOXEL_SET_FREESPACE), 0U);
    const auto free = voxels.getVoxel(VOXEL_SET_FREESPACE, 0).color;
    EXPECT_EQ(free.R, 255) << "free space has no colour of its own";
    EXPECT_EQ(free.G, 127);

    map.renderOptions.drawEllipsoids = false;
    map.renderOptions.drawVoxels = true;
    const auto drawn =
        std::dynamic_pointer_cast<COctoMapVoxels>(*map.getVisualization()->begin());
    ASSERT_TRUE(drawn);
    EXPECT_EQ(drawn->getVisualizationMode(), COctoMapVoxels::FIXED);
}

}  // namespace
