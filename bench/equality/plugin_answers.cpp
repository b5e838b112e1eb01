#include "plugin_answers.h"

#include "components.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>

namespace equality {
namespace {

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

constexpr int kPosesOfScan = 9;
constexpr std::size_t kQuestionStep = 20;  // of points and rays

mrpt::math::TPoint3D toMrpt(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

/// The points of an observation, by MRPT's own means. Throws if there are none.
mrpt::maps::CSimplePointsMap pointsMapOf(const mrpt::obs::CObservation::Ptr& observation) {
    mrpt::maps::CSimplePointsMap points_robot;
    if (const auto depth =
            std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation)) {
        mrpt::obs::T3DPointsProjectionParams projection;
        projection.takeIntoAccountSensorPoseOnRobot = true;
        depth->unprojectInto(points_robot, projection);
    } else {
        points_robot.insertObservation(*observation);
    }
    if (points_robot.empty()) throw std::runtime_error("a scan has no points");
    return points_robot;
}

void addLikelihoods(Dump& dump, const std::string& name, const CHGMMOccupancyMap& map,
                    const std::vector<RecordedScan>& scans) {
    Generator generator(3);
    std::vector<double> values;
    for (const RecordedScan& scan : scans) {
        for (int k = 0; k < kPosesOfScan; ++k) {
            const double far = 0.04 * k;  // [m], and [rad] for the turn
            const Eigen::Vector3d shift_m = generator.inCube(far);
            const Eigen::Vector3d turn_rad = generator.inCube(0.3 * far);
            const CPose3D off(shift_m.x(), shift_m.y(), shift_m.z(), turn_rad.x(),
                              turn_rad.y(), turn_rad.z());
            values.push_back(map.computeObservationLikelihood(*scan.observation,
                                                              scan.T_map_robot + off));
        }
    }
    dump.add(name, Kind::answers, "pose", {"log likelihood"}, values);
}

void addMatching(Dump& dump, const CHGMMOccupancyMap& map,
                 const std::vector<RecordedScan>& scans) {
    std::vector<double> pairs, ratios;
    for (const RecordedScan& scan : scans) {
        const auto points_robot = pointsMapOf(scan.observation);
        mrpt::maps::TMatchingParams params;
        params.decimation_other_map_points = 1 + points_robot.size() / 500;
        mrpt::tfest::TMatchingPairList found;
        mrpt::maps::TMatchingExtraResults extra;
        map.determineMatching3D(&points_robot, scan.T_map_robot, found, params, extra);
        for (const auto& p : found)
            pairs.insert(pairs.end(),
                         {double(p.globalIdx), double(p.localIdx), p.global.x, p.global.y,
                          p.global.z, p.errorSquareAfterTransformation});
        ratios.insert(ratios.end(), {extra.correspondencesRatio, extra.sumSqrDist});
        found.clear();
        const mrpt::poses::CPose2D flat(scan.T_map_robot);
        map.determineMatching2D(&points_robot, flat, found, params, extra);
        ratios.insert(ratios.end(), {extra.correspondencesRatio, extra.sumSqrDist});
    }
    dump.add("matched points", Kind::answers, "pair",
             {"component", "point", "x", "y", "z", "squared distance"}, pairs);
    dump.add("matched scans", Kind::answers, "scan",
             {"share in space", "squares in space", "share in plane", "squares in plane"},
             ratios);
}

void addPointAnswers(Dump& dump, const CHGMMOccupancyMap& map, const Questions& questions) {
    std::vector<double> values;
    for (const auto& point_map : questions.everyPoint(kQuestionStep)) {
        const Eigen::Vector3f p = point_map.cast<float>();
        double probability = 0.0;
        const bool known = map.getPointOccupancy(p.x(), p.y(), p.z(), probability);
        values.insert(values.end(), {known ? 1.0 : 0.0, probability});
        values.push_back(map.squareDistanceToClosestCorrespondence(p.x(), p.y()));
    }
    dump.add("MRPT points", Kind::answers, "point",
             {"known", "probability", "squared distance"}, values);
    std::vector<double> hits;
    for (std::size_t i = 0; i < questions.rays_map.size(); i += kQuestionStep) {
        const Ray& ray = questions.rays_map[i];
        mrpt::math::TPoint3D end;
        const bool hit =
            map.castRay(toMrpt(ray.origin_map), toMrpt(ray.direction_map), end, true);
        hits.insert(hits.end(), {hit ? 1.0 : 0.0, end.x, end.y, end.z});
    }
    dump.add("MRPT rays", Kind::answers, "ray", {"hit", "x", "y", "z"}, hits);
}

}  // namespace

void addPluginAnswers(Dump& dump, const CHGMMOccupancyMap& map,
                      const std::vector<RecordedScan>& scans, const Questions& questions) {
    addLikelihoods(dump, "likelihoods", map, scans);
    addMatching(dump, map, scans);
    addPointAnswers(dump, map, questions);

    mrpt::io::CMemoryStream memory;
    auto archive = mrpt::serialization::archiveFrom(memory);
    archive << map;
    memory.Seek(0);
    const auto copy = archive.ReadObject<CHGMMOccupancyMap>();
    addComponents(dump, "MRPT object read back: ", copy->model());
    addLikelihoods(dump, "MRPT object read back: likelihoods", *copy, scans);
}

hgmm::Scan pointsOf(const RecordedScan& scan) {
    const auto points_robot = pointsMapOf(scan.observation);
    hgmm::Scan result;
    result.x.assign(points_robot.getPointsBufferRef_x().begin(),
                    points_robot.getPointsBufferRef_x().end());
    result.y.assign(points_robot.getPointsBufferRef_y().begin(),
                    points_robot.getPointsBufferRef_y().end());
    result.z.assign(points_robot.getPointsBufferRef_z().begin(),
                    points_robot.getPointsBufferRef_z().end());
    const CPose3D& T = scan.T_map_robot;
    result.T_map_sensor = {T.getRotationMatrix().asEigen(), {T.x(), T.y(), T.z()}};
    return result;
}

}  // namespace equality
