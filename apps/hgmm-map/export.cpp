#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <iomanip>
#include <sstream>

#include "commands.h"
#include "ellipsoid_mesh.h"
#include "export_field.h"
#include "export_gltf.h"
#include "export_octree.h"
#include "export_slice.h"
#include "hgmm/evaluation/reconstruction.h"
#include "load.h"
#include "made_by_python.h"

namespace maptool {
namespace {

using hgmm::mrpt_bridge::FileKind;

constexpr double kSigmas = 2.0;
constexpr int kAllEllipsoids = 10000000;  // the most that renderOptions take

/// Points of every component, the same number of each.
void appendComponentPoints(const hgmm::Gaussian<3>& component_local,
                           const Eigen::Vector3d& origin_map, const ExportOptions& options,
                           std::uint32_t id, hgmm::evaluation::Ply& ply) {
    hgmm::Mixture<3> alone;
    alone.pushBack(component_local);
    const hgmm::evaluation::Points points_map = hgmm::evaluation::sampleSurface(
        alone, origin_map, options.pointsPerComponent, options.seed + id);
    ply.vertices.insert(ply.vertices.end(), points_map.begin(), points_map.end());
    ply.colours.resize(ply.vertices.size(), hgmm::evaluation::colourOf(id));
    ply.components.resize(ply.vertices.size(), id);
}

void exportPly(const hgmm::Map& map, const ExportOptions& options) {
    const hgmm::Mixture<3>& mixture = levelOf(map, options.level, options.mapFile);
    hgmm::evaluation::Ply ply;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const auto id = static_cast<std::uint32_t>(i);
        if (options.pointsPerComponent > 0)
            appendComponentPoints(mixture[i], map.origin(), options, id, ply);
        else
            appendEllipsoid(mixture[i], map.origin(), kSigmas, id, ply);
    }
    hgmm::evaluation::writePly(options.output, ply, replaceFor(options.force));
}

void exportGltf(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    hgmm::mrpt_bridge::writeFile(options.output, gltfOf(map, options.level, kSigmas),
                                 replaceFor(options.force));
}

void exportScene(mrpt::maps::CHGMMOccupancyMap map, const ExportOptions& options) {
    levelOf(map.model(), options.level, options.mapFile);
    if (options.render.colour ==
        static_cast<int>(hgmm::mrpt_bridge::EllipsoidColour::kModality))
        modalitiesOf(map.model(), {options.render.modality}, options.mapFile);
    static_cast<hgmm::mrpt_bridge::RenderParams&>(map.renderOptions) = options.render;
    map.renderOptions.level = static_cast<int>(options.level);
    map.renderOptions.voxelResolution_m = options.resolution_m;
    map.renderOptions.maxEllipsoids = kAllEllipsoids;
    map.genericMapParams.enableSaveAs3DObject = true;
    auto objects = mrpt::opengl::CSetOfObjects::Create();
    map.getVisualizationInto(*objects);
    mrpt::opengl::COpenGLScene scene;
    scene.insert(objects);

    hgmm::mrpt_bridge::OutputFile file({options.output, FileKind::scene},
                                       replaceFor(options.force));
    hgmm::mrpt_bridge::writeObject(file, scene);
    file.commit();
}

void exportPicture(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    const auto number = [](const char* name, double value) {
        std::ostringstream text;
        text << name << '=' << std::setprecision(17) << value;
        return text.str();
    };
    hgmm::mrpt_bridge::writeFile(
        options.output,
        madeByPython(
            "hgmm.picture",
            {"--output=-", "--level=" + std::to_string(options.level),
             number("--yaw", options.yaw_deg), number("--pitch", options.pitch_deg),
             number("--cut", options.cut), "--", options.mapFile}),
        replaceFor(options.force));
}

std::vector<hgmm::mrpt_bridge::Output> outputsOf(const ExportOptions& options) {
    const std::string& file = options.output;
    if (options.format == "ply") return {{file, FileKind::ply}};
    if (options.format == "png") return {{file, FileKind::png}};
    if (options.format == "glb") return {{file, FileKind::gltf}};
    if (options.format == "csv") return {{file, FileKind::text}};
    if (options.format == "pgm") return {{file, FileKind::pgm}};
    if (options.format == "3Dscene") return {{file, FileKind::scene}};
    if (options.format == "yaml")
        return {{file, FileKind::slice}, {pictureBeside(file), FileKind::pgm}};
    if (options.local || !options.offset_map.empty())
        return {{file, FileKind::octree}, {offsetBeside(file), FileKind::numbers}};
    return {{file, FileKind::octree}};
}

}  // namespace

void exportMap(const ExportOptions& options) {
    hgmm::mrpt_bridge::checkOutputs(outputsOf(options), {options.mapFile},
                                    replaceFor(options.force));
    const mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    if (options.format == "ply")
        exportPly(map.model(), options);
    else if (options.format == "png")
        exportPicture(map.model(), options);
    else if (options.format == "glb")
        exportGltf(map.model(), options);
    else if (options.format == "csv" || options.format == "pgm")
        exportField(map.model(), options);
    else if (options.format == "3Dscene")
        exportScene(map, options);
    else if (options.format == "yaml")
        exportSlice(map.model(), options);
    else
        exportOctree(map.model(), options);
}

}  // namespace maptool
