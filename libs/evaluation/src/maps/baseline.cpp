#include "hgmm/evaluation/baseline.h"

#include <functional>
#include <stdexcept>

#include "hgmm/evaluation/gp_octomap_baseline.h"
#include "hgmm/evaluation/grid3d_baseline.h"
#include "hgmm/evaluation/ndt_baseline.h"
#include "hgmm/evaluation/ndt_om_baseline.h"
#include "hgmm/evaluation/nearest_baseline.h"
#include "hgmm/evaluation/parse_numbers.h"
#include "maps/octomap_baseline.h"

namespace hgmm::evaluation {
namespace {

struct Entry {
    std::string name, line;
    double depthCamera_m, lidar_m;  ///< usual resolutions; 0: it has none
    std::function<std::unique_ptr<Baseline>(double resolution_m)> make;
};

template <class B>
std::unique_ptr<Baseline> withResolution(double resolution_m) {
    return std::make_unique<B>(resolution_m);
}

std::unique_ptr<Baseline> publishedGpOctomap(double resolution_m) {
    return std::make_unique<GpOctomapBaseline>(GpOctomapParams::asPublished(resolution_m));
}

std::unique_ptr<Baseline> nearest(double) {
    return std::make_unique<NearestBaseline>();
}

const std::vector<Entry>& entries() {
    static const std::vector<Entry> all{
        {"octomap", "octree of voxels (MRPT's COctoMap)", 0.05, 0.3,
         withResolution<OctomapBaseline>},
        {"grid3d", "dense grid of voxels (MRPT's COccupancyGridMap3D)", 0.05, 0.3,
         withResolution<Grid3dBaseline>},
        {"ndt", "one Gaussian of surface points per cell", 0.1, 0.4,
         withResolution<NdtBaseline>},
        {"ndt-om", "one Gaussian per cell, and the cell's occupancy", 0.1, 0.4,
         withResolution<NdtOmBaseline>},
        {"gpoctomap", "local Gaussian processes fused into an octree", 0.05, 0.3,
         withResolution<GpOctomapBaseline>},
        {"gpoctomap-published", "the same with the settings of its authors' code", 0.05,
         0.3, publishedGpOctomap},
        {"nn", "distance from the nearest of all points", 0.0, 0.0, nearest}};
    return all;
}

[[noreturn]] void refuse(const std::string& specification) {
    std::string names;
    for (const Entry& entry : entries()) names += (names.empty() ? "" : ", ") + entry.name;
    throw std::invalid_argument("'" + specification + "' is no baseline; give one of " +
                                names +
                                ", or with a resolution of your own, in metres, such as "
                                "octomap:0.05 (nn has none)");
}

const Entry& entryOf(const std::string& name, const std::string& specification) {
    for (const Entry& entry : entries())
        if (entry.name == name) return entry;
    refuse(specification);
}

double resolutionOf(const std::string& text, const std::string& specification) {
    std::vector<double> numbers;
    try {
        numbers = parseNumbers(text);
    } catch (const std::runtime_error&) {
        refuse(specification);
    }
    if (numbers.size() != 1 || numbers[0] <= 0.0) refuse(specification);
    return numbers[0];
}

}  // namespace

std::unique_ptr<Baseline> makeBaseline(const std::string& specification,
                                       SensorKind sensor) {
    const std::size_t colon = specification.find(':');
    const std::string name = specification.substr(0, colon);
    const Entry& entry = entryOf(name, specification);
    if (colon == std::string::npos)
        return entry.make(sensor == SensorKind::lidar ? entry.lidar_m
                                                      : entry.depthCamera_m);
    if (entry.depthCamera_m == 0.0) refuse(specification);
    return entry.make(resolutionOf(specification.substr(colon + 1), specification));
}

const std::vector<std::pair<std::string, std::string>>& baselineNames() {
    static const std::vector<std::pair<std::string, std::string>> names = [] {
        std::vector<std::pair<std::string, std::string>> all;
        for (const Entry& entry : entries()) all.emplace_back(entry.name, entry.line);
        return all;
    }();
    return names;
}

}  // namespace hgmm::evaluation
