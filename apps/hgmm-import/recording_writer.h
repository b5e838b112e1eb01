#pragma once
#include <hgmm/evaluation/trajectory.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "hgmm/mrpt_bridge/gzip_output.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "motion_action.h"
#include "sources/source.h"

namespace hgmm::importer {

/// Where an import goes to, and in which form.
struct RecordingOutputs {
    std::string rawlog;     ///< gzip-compressed MRPT rawlog
    std::string poses;      ///< TUM lines: T_world_robot at the observations' time stamps
    std::string simplemap;  ///< MRPT simple map of the same; empty: none
    /// Simple map of one cloud, at the origin, of all points in the world frame, for MRPT's
    /// points maps: those of 2.5 lose the robot's pose when they insert a point cloud.
    /// Empty: none.
    std::string cloud;
    bool actions = false;  ///< pairs of movement and sensory frame instead of observations
    OdometryNoise noise;   ///< of these movements
    double turnErrorPerMetre_deg = 1;  ///< deviation that 2D movements state [deg/m]
    std::uint64_t seed = 1;
    mrpt_bridge::Replace replace = mrpt_bridge::Replace::sameKind;

    /// What checkOutputs looks at.
    std::vector<mrpt_bridge::Output> files() const;
};

/// Writes scans, in the order of time, to a rawlog, a pose file and, if asked for, a simple
/// map or cloud (which are held in memory until commit). The rawlog needs no files besides
/// it.
class RecordingWriter {
 public:
    /// Throws std::runtime_error if a file cannot be written.
    explicit RecordingWriter(const RecordingOutputs& outputs);

    /// Stamps the observation and writes it. Throws std::runtime_error if the time is not
    /// within
    /// +-1e10 s (about 300 years) of the epoch, as nanoseconds would not be, or if the disk
    /// is full.
    void add(const ImportedScan& scan);

    /// Puts all files in their places, or none; without this none of them appears.
    void commit();

 private:
    void addToCloud(const ImportedScan& scan);
    void writeActionPair(const ImportedScan& scan,
                         const mrpt::obs::CSensoryFrame::Ptr& frame);

    RecordingOutputs outputs_;
    mrpt_bridge::OutputFile rawlogFile_, posesFile_;
    std::optional<mrpt_bridge::OutputFile> simplemapFile_, cloudFile_;
    mrpt_bridge::GzipOutput rawlog_;
    evaluation::Trajectory trajectory_;
    mrpt::maps::CSimpleMap simplemap_;
    mrpt::maps::CSimplePointsMap::Ptr cloud_ = mrpt::maps::CSimplePointsMap::Create();
    std::mt19937_64 generator_;
};

}  // namespace hgmm::importer
