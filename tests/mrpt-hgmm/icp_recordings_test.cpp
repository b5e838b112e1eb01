#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CICP.h>
#include <mrpt/slam/CMetricMapBuilderICP.h>
#include <mrpt/system/CTicTac.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>

#include "observations.h"

/// MRPT's ICP on our map and on a points map of the same scans: same starts, same options.
namespace {

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::maps::CSimplePointsMap;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;

constexpr double kOff_m = 0.5, kOff_rad = 5 * M_PI / 180;
constexpr double kConverged_m = 0.15, kConverged_deg = 1.5;

class Random {
 public:
    double uniform(double low, double high) {
        return low + (high - low) * double(engine_() >> 11U) * 0x1.0p-53;
    }
    mrpt::math::TPoint3D direction() {
        const double z = uniform(-1, 1), angle = uniform(-M_PI, M_PI);
        const double r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

 private:
    std::mt19937_64 engine_{1};
};

/// How alignments to one map went.
class Tally {
 public:
    explicit Tally(std::string map) : map_(std::move(map)) {}

    void add(const CPose3D& error, double seconds) {
        const auto R = error.getRotationMatrix();
        const double cosine = (R(0, 0) + R(1, 1) + R(2, 2) - 1) / 2;
        const double error_deg = mrpt::RAD2DEG(std::acos(std::clamp(cosine, -1.0, 1.0)));
        errors_m_.push_back(error.norm());
        errors_deg_.push_back(error_deg);
        seconds_ += seconds;
        if (error.norm() < kConverged_m && error_deg < kConverged_deg) ++converged_;
    }
    int converged() const { return converged_; }
    void print() {
        std::cout << map_ << ": " << converged_ << " of " << errors_m_.size()
                  << " converge, median error " << median(errors_m_) << " m, "
                  << median(errors_deg_) << " deg, "
                  << 1e3 * seconds_ / double(errors_m_.size()) << " ms each\n";
    }

 private:
    static double median(std::vector<double> values) {
        std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
        return values[values.size() / 2];
    }

    std::string map_;
    std::vector<double> errors_m_, errors_deg_;
    double seconds_ = 0;
    int converged_ = 0;
};

mrpt::slam::CICP patientIcp() {
    mrpt::slam::CICP icp;
    icp.options.maxIterations = 100;
    return icp;
}

struct LaserFrame {
    CPose2D pose;
    mrpt::obs::CSensoryFrame::Ptr observations;
};

/// The Telecom loop with poses by MRPT's own ICP mapping, on points.
std::vector<LaserFrame> telecomLoop() {
    mrpt::obs::CRawlog log;
    const std::string file = std::string(observations::datasets()) +
                             "2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
    if (!log.loadFromRawLogFile(file)) return {};
    mrpt::slam::CMetricMapBuilderICP builder;
    builder.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    CSimplePointsMap::TMapDefinition points;
    points.insertionOpts.minDistBetweenLaserPoints = 0.05F;
    builder.ICP_options.mapInitializers.push_back(points);
    builder.ICP_options.localizationLinDistance = 0.05;
    builder.ICP_options.localizationAngDistance = 0.02;
    builder.ICP_params.maxIterations = 80;
    builder.ICP_params.thresholdDist = 0.3;
    builder.ICP_params.thresholdAng = mrpt::DEG2RAD(5);
    builder.ICP_params.ALFA = 0.8;
    builder.ICP_params.smallestThresholdDist = 0.05;
    builder.ICP_params.corresponding_points_decimation = 1;
    builder.initialize();
    std::vector<LaserFrame> frames;
    for (std::size_t entry = 0; entry < log.size();) {
        mrpt::obs::CActionCollection::Ptr action;
        mrpt::obs::CSensoryFrame::Ptr observations;
        if (!log.getActionObservationPair(action, observations, entry)) break;
        builder.processActionObservation(*action, *observations);
        frames.push_back(
            {CPose2D(builder.getCurrentPoseEstimation()->getMeanVal()), observations});
    }
    return frames;
}

TEST(IcpRecordings, TelecomFramesConvergeAsOftenAsOnPoints) {
    const auto frames = telecomLoop();
    ASSERT_GT(frames.size(), 200U);
    CHGMMOccupancyMap map;
    CSimplePointsMap points;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        if (k % 5 == 2) continue;
        frames[k].observations->insertObservationsInto(map, CPose3D(frames[k].pose));
        frames[k].observations->insertObservationsInto(points, CPose3D(frames[k].pose));
    }
    mrpt::slam::CICP icp = patientIcp();
    Tally ofMap("hgmm"), ofPoints("points");
    Random random;
    for (int repetition = 0; repetition < 3; ++repetition)
        for (std::size_t k = 2; k < frames.size(); k += 5) {
            CSimplePointsMap scan;
            frames[k].observations->insertObservationsInto(scan);
            const double angle = random.uniform(-M_PI, M_PI);
            const CPose2D& truth = frames[k].pose;
            const CPose2D start(
                truth.x() + kOff_m * std::cos(angle), truth.y() + kOff_m * std::sin(angle),
                truth.phi() + (random.uniform(-1, 1) < 0 ? -1 : 1) * kOff_rad);
            const auto align = [&](const mrpt::maps::CMetricMap& reference, Tally& tally) {
                mrpt::system::CTicTac clock;
                const auto pdf = icp.Align(&reference, &scan, start);
                tally.add(CPose3D(pdf->getMeanVal() - truth), clock.Tac());
            };
            align(map, ofMap);
            align(points, ofPoints);
        }
    ofMap.print();
    ofPoints.print();
    EXPECT_GE(ofMap.converged(), ofPoints.converged());
    EXPECT_GE(ofMap.converged(), 125) << "of 135";
}

/// Points of a binary PCD file with fields x y z intensity, in metres.
CSimplePointsMap readPcd(const std::string& file) {
    CSimplePointsMap points;
    std::ifstream in(file, std::ios::binary);
    std::string line;
    while (std::getline(in, line) && line.rfind("DATA", 0) != 0) {
    }
    EXPECT_EQ(line, "DATA binary") << file;
    float p[4];
    while (in.read(reinterpret_cast<char*>(p), sizeof p))
        points.insertPoint(p[0], p[1], p[2]);
    return points;
}

std::vector<CPose3D> readPoses(const std::string& file) {
    std::vector<CPose3D> poses;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream fields(line);
        double stamp = 0, x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0;
        if (fields >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw)
            poses.emplace_back(mrpt::math::CQuaternionDouble(qw, qx, qy, qz), x, y, z);
    }
    return poses;
}

/// The first 150 scans: one in five is kept from the maps, one in ten aligned.
TEST(IcpRecordings, LivoxScansConvergeAsOftenAsOnPoints) {
    const char* data = std::getenv("HGMM_DATA_DIR");
    if (!data) GTEST_SKIP() << "SKIPPED: HGMM_DATA_DIR is not set";
    const std::string folder = std::string(data) + "/livox_building/";
    const auto poses = readPoses(folder + "poses_tum.txt");
    ASSERT_GE(poses.size(), 150U);
    const CPose3D T_body_sensor(0.0417, 0.0233, -0.0284, 0, 0, 0);
    CHGMMOccupancyMap map;
    CSimplePointsMap points;
    std::vector<std::pair<CPose3D, CSimplePointsMap>> kept;
    for (int k = 0; k < 150; ++k) {
        const CSimplePointsMap scan =
            readPcd(folder + "scans/" + mrpt::format("%06d.pcd", k));
        ASSERT_GT(scan.size(), 100U);
        if (k % 10 == 4) kept.emplace_back(poses[k], scan);
        if (k % 5 == 4) continue;
        auto observation = mrpt::obs::CObservationPointCloud::Create();
        auto seen = CSimplePointsMap::Create();
        seen->changeCoordinatesReference(scan, -T_body_sensor);
        observation->pointcloud = seen;
        observation->sensorPose = T_body_sensor;
        map.insertObservation(*observation, poses[k]);
        points.insertAnotherMap(&scan, poses[k]);
    }
    mrpt::slam::CICP icp = patientIcp();
    Tally ofMap("hgmm"), ofPoints("points");
    Random random;
    for (const auto& [truth, scan] : kept)
        for (int repetition = 0; repetition < 2; ++repetition) {
            const auto shift = random.direction() * kOff_m, turn = random.direction();
            CPose3D off(shift.x, shift.y, shift.z, 0, 0, 0);
            const double half = kOff_rad / 2;
            off = off + CPose3D(mrpt::math::CQuaternionDouble(
                                    std::cos(half), std::sin(half) * turn.x,
                                    std::sin(half) * turn.y, std::sin(half) * turn.z),
                                0, 0, 0);
            const CPose3D start = truth + off;
            const auto align = [&, &from = truth, &what = scan](
                                   const mrpt::maps::CMetricMap& reference, Tally& tally) {
                mrpt::system::CTicTac clock;
                const auto pdf = icp.Align3D(&reference, &what, start);
                tally.add(CPose3D(pdf->getMeanVal()) - from, clock.Tac());
            };
            align(map, ofMap);
            align(points, ofPoints);
        }
    ofMap.print();
    ofPoints.print();
    EXPECT_GE(ofMap.converged(), ofPoints.converged());
    EXPECT_GE(ofMap.converged(), 27) << "of 30";
}

}  // namespace
