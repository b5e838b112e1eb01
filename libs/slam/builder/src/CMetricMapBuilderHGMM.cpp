#include <hgmm/mrpt_bridge/mrpt_compat.h>
#include <hgmm/mrpt_bridge/observation_to_scan.h>
#include <hgmm/slam/odometry.h>
#include <hgmm/slam/submap_slam.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/slam/CMetricMapBuilderHGMM.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace mrpt::slam {

namespace {

using hgmm::Pose;
using hgmm::mrpt_bridge::toCPose3D;
using hgmm::mrpt_bridge::toPose;
using hgmm::slam::UncertainPose;
using mrpt::maps::CHGMMOccupancyMap;

constexpr double kKeyframe_m = 0.25, kKeyframe_rad = 0.25;

/// A frame that is kept, and its index in the trajectory.
struct Keyframe {
    std::size_t index = 0;
    mrpt::obs::CSensoryFrame::Ptr frame;
};

/// A range observation and what is to be learnt from it.
struct RangeScan {
    const mrpt::obs::CObservation* observation = nullptr;
    hgmm::Scan scan;
};

}  // namespace

struct CMetricMapBuilderHGMM::Impl {
    explicit Impl(const CHGMMOccupancyMap::TInsertionOptions& insertion)
        : options(insertion), slam(options.params) {}

    std::optional<RangeScan> rangeScanIn(const mrpt::obs::CSensoryFrame& frame) const {
        for (const auto& observation : frame) {
            if (label && observation->sensorLabel != *label) continue;
            auto scan = hgmm::mrpt_bridge::observationToScan(
                *observation, std::nullopt, hgmm::mrpt_bridge::Channels::none,
                options.reading);
            if (scan) return RangeScan{observation.get(), std::move(*scan)};
        }
        return {};
    }

    void begin(const mrpt::obs::CObservation& observation) {
        label = observation.sensorLabel;
        T_robot_sensor = hgmm::mrpt_bridge::sensorPoseInMap(observation, std::nullopt);
        odometry.emplace(options.params, T_robot_sensor);
    }

    void follow(const RangeScan& range, bool enters) {
        time_s = std::max(time_s, mrpt::Clock::toDouble(range.observation->timestamp));
        std::optional<UncertainPose> motion;
        if (T_last_now) motion = hgmm::slam::givenMotion(*T_last_now);
        T_last_now.reset();
        const UncertainPose step = odometry->step(range.scan, time_s, motion);
        const UncertainPose T_entered_now = notEntered * step;
        if (enters && odometry->held()) {
            slam.add(odometry->lastSamples(), T_robot_sensor, T_entered_now);
            T_slam_robot = slam.T_world_robot();
        } else {
            slam.addLost(T_entered_now);
            T_slam_robot = slam.T_world_robot() * T_entered_now.T_a_b;
        }
        ++scans;
        if (!odometry->held()) return;
        notEntered = enters ? UncertainPose{} : T_entered_now;
    }

    void keep(const mrpt::obs::CSensoryFrame& frame) {
        if (!keyframes.empty()) {
            const hgmm::slam::Vector6d moved =
                hgmm::slam::errorOf(T_slam_robot, T_slam_keyframe);
            if (moved.tail<3>().norm() < kKeyframe_m &&
                moved.head<3>().norm() < kKeyframe_rad)
                return;
        }
        T_slam_keyframe = T_slam_robot;
        keyframes.push_back({scans - 1, mrpt::obs::CSensoryFrame::Create(frame)});
    }

    CHGMMOccupancyMap::TInsertionOptions options;
    hgmm::slam::SubmapSlam slam;
    std::optional<hgmm::slam::Odometry> odometry;
    std::optional<std::string> label;  // of the sensor
    Pose T_robot_sensor, T_map_start;
    Pose T_slam_robot, T_slam_keyframe;  // now; at the last keyframe, as it was then
    std::size_t scans = 0;
    std::optional<Pose> T_last_now;  // by actions
    UncertainPose notEntered;        // motion since the last scan that entered the map
    double time_s = 0.0;
    std::vector<Keyframe> keyframes;
    mrpt::maps::CMultiMetricMap metricMap;  // as it was asked for; none if empty
};

CMetricMapBuilderHGMM::CMetricMapBuilderHGMM(
    const CHGMMOccupancyMap::TInsertionOptions& insertion)
    : impl_(std::make_unique<Impl>(insertion)) {}

CMetricMapBuilderHGMM::~CMetricMapBuilderHGMM() = default;

void CMetricMapBuilderHGMM::initialize(const mrpt::maps::CSimpleMap& initialMap,
                                       const mrpt::poses::CPosePDF* x0) {
    if (!initialMap.empty())
        throw std::invalid_argument("CMetricMapBuilderHGMM: does not go on from a map");
    impl_ = std::make_unique<Impl>(impl_->options);
    if (x0) impl_->T_map_start = toPose(mrpt::poses::CPose3D(x0->getMeanVal()));
}

mrpt::poses::CPose3DPDF::Ptr CMetricMapBuilderHGMM::getCurrentPoseEstimation() const {
    auto pose = mrpt::poses::CPose3DPDFGaussian::Create();
    pose->mean = toCPose3D(impl_->T_map_start * impl_->T_slam_robot);
    pose->cov.setZero();
    const hgmm::slam::PoseGraph& graph = impl_->slam.graph();
    if (graph.T_world_node.empty()) return pose;
    const hgmm::slam::Matrix6d covariance = poseOfAll(graph, 0).back().covariance;
    // (w, v) of ours about the axes of the map; MRPT's (x, y, z, yaw, pitch, roll), nearly
    // level.
    constexpr int kOurs[] = {3, 4, 5, 2, 1, 0};
    for (int row = 0; row < 6; ++row)
        for (int col = 0; col < 6; ++col)
            pose->cov(row, col) = covariance(kOurs[row], kOurs[col]);
    return pose;
}

bool CMetricMapBuilderHGMM::isLost() const {
    return impl_->odometry && impl_->odometry->lost();
}

void CMetricMapBuilderHGMM::processActionObservation(
    mrpt::obs::CActionCollection& action, mrpt::obs::CSensoryFrame& observations) {
    Impl& m = *impl_;
    mrpt::poses::CPose3D movement;
    if (action.getFirstMovementEstimationMean(movement))
        m.T_last_now = m.T_last_now.value_or(Pose{}) * toPose(movement);
    const std::optional<RangeScan> range = m.rangeScanIn(observations);
    if (!range) return;
    m.metricMap.maps.clear();
    if (!m.odometry) m.begin(*range->observation);
    m.follow(*range, options.enableMapUpdating);
    if (options.enableMapUpdating && m.odometry->held()) m.keep(observations);
}

void CMetricMapBuilderHGMM::getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const {
    out_map.clear();
    const std::vector<Pose> poses = impl_->slam.trajectory();
    for (const Keyframe& keyframe : impl_->keyframes)
        out_map.insert(mrpt::poses::CPose3DPDFGaussian::Create(
                           toCPose3D(impl_->T_map_start * poses[keyframe.index])),
                       keyframe.frame);
}

unsigned int CMetricMapBuilderHGMM::getCurrentlyBuiltMapSize() {
    return static_cast<unsigned int>(impl_->keyframes.size());
}

CMetricMapBuilderHGMM::BuiltMetricMap CMetricMapBuilderHGMM::getCurrentlyBuiltMetricMap()
    const {
    Impl& m = *impl_;
    if (m.metricMap.maps.empty()) {
        auto map = CHGMMOccupancyMap::Create();
        map->insertionOptions = m.options;
        hgmm::Map placed(m.options.params);
        placed.merge(m.slam.fusedMap(), m.T_map_start);
        map->model() = std::move(placed);
        m.metricMap.maps.push_back(map);
    }
    return hgmm::mrpt_bridge::returnedAs<BuiltMetricMap>(m.metricMap);
}

void CMetricMapBuilderHGMM::saveCurrentEstimationToImage(const std::string& file, bool) {
    hgmm::mrpt_bridge::referenceTo(getCurrentlyBuiltMetricMap())
        .maps.front()
        ->saveMetricMapRepresentationToFile(file);
}

}  // namespace mrpt::slam
