#pragma once
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hgmm/evaluation/rawlog_reader.h"

namespace hgmm::evaluation {

/// One observation that mrpt_bridge::isSupported, with the pose of the robot that made it.
struct RecordedScan {
    std::size_t index = 0;  ///< among the scans of the recording, from 0
    double time_s = 0.0;    ///< seconds since the epoch of UNIX
    mrpt::obs::CObservation::Ptr observation;
    mrpt::poses::CPose3D T_map_robot;
};

/// Where robot poses come from.
enum class PoseSource {
    file,      ///< a pose file, matched by time
    odometry,  ///< motions or odometry readings in the recording
    identity   ///< none: a single scan, whose robot defines the map frame, or none required
};

struct RecordingOptions {
    std::optional<std::string> posesFile;  ///< T_map_robot over time (readTrajectory)
    std::size_t from = 0;                  ///< first scan that is needed [index]
    std::size_t to = std::numeric_limits<std::size_t>::max();  ///< last one [index]
    bool posesRequired = true;  ///< false: scans without known poses are at the origin
    /// Label of the only sensor whose observations count; all if there is none.
    std::optional<std::string> sensorLabel = std::nullopt;
};

/// Poses of a file are interpolated where the nearest is not farther away than this [s].
constexpr double kMaxPoseGap_s = 0.1;

/// A rawlog of either format (single observations, or pairs of actions and sensory frames),
/// as a stream of scans with poses.
///
/// The file is read twice: once here for times and motions, once through next();
/// observations are never held. Poses come from the pose file if there is one; else motions
/// of actions are composed (their means), or odometry readings interpolated by time.
class Recording {
 public:
    /// Throws std::runtime_error naming the file: missing, empty, no scans within from..to,
    /// poses that do not cover the scans (how many), or neither poses nor odometry for
    /// several scans.
    Recording(const std::string& file, const RecordingOptions& options = {});

    /// The next scan within from..to; nothing at the end.
    std::optional<RecordedScan> next();

    /// Scans within from..to.
    std::size_t size() const { return T_map_robot_.size(); }
    PoseSource poseSource() const { return poseSource_; }
    /// MRPT class of the first scan's observation.
    const std::string& sensor() const { return sensor_; }
    /// Labels of the sensors of all scans, those that do not count included, sorted.
    const std::set<std::string>& sensorLabels() const { return sensorLabels_; }
    /// RawlogReader::damage(), with the number of scans that are left; empty for a whole
    /// file.
    const std::string& damage() const { return damage_; }

 private:
    struct Survey;

    void collectScans(const mrpt::serialization::CSerializable::Ptr& entry,
                      std::deque<mrpt::obs::CObservation::Ptr>& scans) const;
    void resolvePoses(const Survey& survey);
    void posesFromFile(const Survey& survey);

    std::string file_;
    RecordingOptions options_;
    std::vector<mrpt::poses::CPose3D> T_map_robot_;  // of scan from + i
    PoseSource poseSource_ = PoseSource::identity;
    std::string sensor_;
    std::set<std::string> sensorLabels_;
    std::string damage_;

    RawlogReader reader_;
    std::deque<mrpt::obs::CObservation::Ptr> pending_;  // scans of the entry last read
    std::size_t nextIndex_ = 0;
};

}  // namespace hgmm::evaluation
