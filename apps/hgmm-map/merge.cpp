#include <mrpt/core/bits_math.h>
#include <mrpt/poses/CPose3D.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "commands.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/registration.h"
#include "load.h"

namespace maptool {
namespace {

using hgmm::Map;
using hgmm::Pose;

Pose poseOf(const std::vector<double>& p) {
    if (p.empty()) return {};
    for (const double number : p)
        if (!std::isfinite(number)) throw std::runtime_error("--pose: must be finite");
    return hgmm::mrpt_bridge::toPose(mrpt::poses::CPose3D(
        p[0], p[1], p[2], mrpt::DEG2RAD(p[3]), mrpt::DEG2RAD(p[4]), mrpt::DEG2RAD(p[5])));
}

/// The pose of B in A, aligned from a guess.
Pose refined(const Map& a, const Map& b, const Pose& T_a_b) {
    std::vector<const hgmm::Mixture<3>*> levels;
    for (std::size_t level = a.levelCount(); level-- > 0;)
        levels.push_back(&a.mixture(level));
    // Registration works in the maps' local frames.
    const Pose guess{T_a_b.R, T_a_b.t + T_a_b.R * b.origin() - a.origin()};
    const hgmm::Registration r = hgmm::registerMixtures(levels, b.mixture(), guess);
    std::printf("aligned: %.0f %% of the other map's components overlap\n",
                100.0 * r.overlap);
    if (!r.converged)
        throw std::runtime_error(
            "--refine: the maps could not be aligned from this pose; too little of the "
            "other one overlaps, or the pose is too far off");
    const Pose& T = r.T_target_source;
    return {T.R, T.t + a.origin() - T.R * b.origin()};
}

void printPose(const Pose& T) {
    const mrpt::poses::CPose3D pose = hgmm::mrpt_bridge::toCPose3D(T);
    const auto degrees = [](double angle_rad) {
        return mrpt::RAD2DEG(angle_rad) + 0.0;  // -0 is printed as such
    };
    std::printf("pose of the other map  %.4f,%.4f,%.4f,%.3f,%.3f,%.3f (m, deg)\n", pose.x(),
                pose.y(), pose.z(), degrees(pose.yaw()), degrees(pose.pitch()),
                degrees(pose.roll()));
}

}  // namespace

void merge(const MergeOptions& options) {
    hgmm::mrpt_bridge::checkOutputs({{options.output, hgmm::mrpt_bridge::FileKind::map}},
                                    {options.mapFile, options.otherFile},
                                    replaceFor(options.force));
    mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    const mrpt::maps::CHGMMOccupancyMap other = loadMap(options.otherFile);
    Pose T_map_other = poseOf(options.pose);
    if (options.refine) {
        if (map.model().empty() || other.model().empty())
            throw std::runtime_error("--refine: an empty map cannot be aligned");
        T_map_other = refined(map.model(), other.model(), T_map_other);
    }
    printPose(T_map_other);
    const std::size_t before = map.model().mixture().size();
    map.model().merge(other.model(), T_map_other);
    std::printf("components  %zu and %zu became %zu\n", before,
                other.model().mixture().size(), map.model().mixture().size());
    map.saveToFile(options.output, options.force);
}

}  // namespace maptool
