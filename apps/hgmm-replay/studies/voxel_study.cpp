#include "studies/voxel_study.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "format.h"
#include "hgmm/evaluation/occupied_voxels.h"
#include "hgmm/evaluation/reconstruction.h"
#include "hgmm/mrpt_bridge/voxel_grid.h"
#include "map_setup.h"
#include "replay_scans.h"
#include "report.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

struct VoxelMap {
    std::string name;
    Points voxels_map;  ///< centres [m]
};

/// Our map's own voxels: surfaces thinner than a voxel need not pass its centre.
Points voxelsOf(const hgmm::Map& map, const VoxelGrid& grid) {
    hgmm::mrpt_bridge::VoxelParams params;
    params.resolution_m = grid.edge_m;
    params.free = false;
    const Eigen::Array3d low = grid.min_map,
                         high = low + grid.edge_m * grid.count.array().cast<double>();
    Points voxels_map;
    for (const auto& voxel : hgmm::mrpt_bridge::voxelise(map, params).voxels)
        if ((voxel.centre_map.array() > low).all() &&
            (voxel.centre_map.array() < high).all())
            voxels_map.push_back(voxel.centre_map);
    return voxels_map;
}

std::vector<VoxelMap> voxelsOf(const Replayed& replayed, const VoxelGrid& grid) {
    std::vector<VoxelMap> maps;
    maps.push_back({"hgmm", voxelsOf(replayed.map->model(), grid)});
    for (const ReplayedBaseline& baseline : replayed.baselines) {
        const Baseline& map = *baseline.map;
        if (map.meaning() != Meaning::occupancy) continue;
        maps.push_back(
            {baseline.name,
             occupiedVoxels([&map](const Eigen::Vector3d* points_map, std::size_t n,
                                   Answer* answers) { map.query(points_map, n, answers); },
                            grid)});
    }
    return maps;
}

/// One line, and what the picture's caption says.
std::string describe(const VoxelMap& map, const Points& measured_map, double edge_m) {
    if (map.voxels_map.empty()) return "no voxel is occupied";
    // A voxel's centre is at most half its diagonal from a surface within it.
    const double reach_m = edge_m * std::sqrt(3.0) / 2.0;
    const Reconstruction r = compareSurfaces(map.voxels_map, measured_map, reach_m);
    return format(
        "%zu voxels; %.3f of the measured points lie within one, %.3f of the "
        "voxels at one",
        map.voxels_map.size(), r.recall, r.precision);
}

PointPicture pictureOf(const std::string& title, const std::string& caption,
                       const Points& points_map) {
    PointPicture picture;
    picture.title = title;
    picture.caption = caption;
    picture.points.vertices = points_map;
    return picture;
}

}  // namespace

void voxelStudy(Recording& recording, const Options& given) {
    const bool depthCamera = sensorKindOf(recording.sensor()) == SensorKind::depthCamera;
    const double edge_m = depthCamera ? 0.05 : 0.2;
    Options options = given;
    if (options.baselines.empty())
        options.baselines = {"grid3d:" + format("%g", edge_m), "ndt-om", "gpoctomap"};
    const Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (replayed.run.scansMapped == 0 || replayed.testPoints.empty())
        throw std::runtime_error(options.log +
                                 ": no scan was left to build a map from, or to test it");
    const Points& measured_map = replayed.testPoints.reference();
    const std::vector<VoxelMap> maps =
        voxelsOf(replayed, gridAround(replayed.input_map, edge_m));

    std::printf("study fig3.8: voxels of %g m, %zu scans mapped, %zu tested\n", edge_m,
                replayed.run.scansMapped, replayed.run.scansTested);
    std::vector<std::string> texts;
    for (const VoxelMap& map : maps) {
        texts.push_back(describe(map, measured_map, edge_m));
        std::printf("  %-16s  %s\n", map.name.c_str(), texts.back().c_str());
    }
    if (!options.reportFolder) return;
    std::vector<PointPicture> pictures{pictureOf(
        "Input",
        format("%zu of the points that the maps were given", replayed.input_map.size()),
        replayed.input_map)};
    for (std::size_t i = 0; i < maps.size(); ++i) {
        if (maps[i].voxels_map.empty()) continue;
        pictures.push_back(pictureOf(maps[i].name, texts[i], maps[i].voxels_map));
        pictures.back().edge_m = edge_m;
    }
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        pictures[i].file = format("fig3.8_%zu.ply", i);
        pictures[i].view = reportView(sensorKindOf(replayed.run.sensor));
    }
    writeReport(replayed, evaluateReplayed(replayed), options, pictures);
}

}  // namespace replay
