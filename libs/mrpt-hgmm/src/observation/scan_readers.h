#pragma once
#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <initializer_list>
#include <mutex>
#include <string>
#include <utility>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/scan.h"

/// One reader per observation type. Each fills points, channels if these are wanted, and
/// cleared rays, in the sensor frame and leaves T_map_sensor alone; false means that the
/// observation cannot be understood.
namespace hgmm::mrpt_bridge {

bool readScan(const mrpt::obs::CObservation2DRangeScan& observation, Channels channels,
              const ReadingParams& reading, Scan& scan);
bool readScan(const mrpt::obs::CObservation3DRangeScan& observation, Channels channels,
              const ReadingParams& reading, Scan& scan);
bool readScan(const mrpt::obs::CObservationPointCloud& observation, Channels channels,
              const ReadingParams& reading, Scan& scan);
bool readScan(const mrpt::obs::CObservationVelodyneScan& observation, Channels channels,
              const ReadingParams& reading, Scan& scan);
bool readScan(const mrpt::obs::CObservationRotatingScan& observation, Channels channels,
              const ReadingParams& reading, Scan& scan);

/// Whether readScan would understand the observation, as far as can be told without its
/// data.
template <typename Observation>
bool canRead(const Observation&) {
    return true;
}
bool canRead(const mrpt::obs::CObservationVelodyneScan& observation);
bool canRead(const mrpt::obs::CObservationRotatingScan& observation);

/// Calls visit(observation as its own type) if the type is one of those above.
template <typename Visitor>
bool visitSupported(const mrpt::obs::CObservation& observation, Visitor&& visit) {
    using namespace mrpt::obs;
    if (const auto* o = dynamic_cast<const CObservation2DRangeScan*>(&observation))
        return visit(*o);
    if (const auto* o = dynamic_cast<const CObservation3DRangeScan*>(&observation))
        return visit(*o);
    if (const auto* o = dynamic_cast<const CObservationPointCloud*>(&observation))
        return visit(*o);
    if (const auto* o = dynamic_cast<const CObservationVelodyneScan*>(&observation))
        return visit(*o);
    if (const auto* o = dynamic_cast<const CObservationRotatingScan*>(&observation))
        return visit(*o);
    return false;
}

/// Held while an observation's external file is in memory: loading changes observations
/// that are const to all others.
std::mutex& externalStorageMutex();

/// Prints a message on stderr the first time that it is given.
void warnOnce(const std::string& message);

/// Fills a scan point by point, dropping those that are not finite, with their channel
/// values.
class ScanWriter {
 public:
    ScanWriter(Scan& scan, Channels channels,
               std::initializer_list<const char*> channelNames)
        : scan_(scan) {
        if (channels == Channels::none) return;
        for (const char* name : channelNames) scan_.channels.push_back({name, {}});
    }

    void reserve(std::size_t n) {
        scan_.reserve(n);
        for (Channel& channel : scan_.channels) channel.values.reserve(n);
    }

    /// One value per channel named in the constructor, unwanted ones included.
    template <typename... Values>
    void pushBack(float x, float y, float z, Values... values) {
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return;
        scan_.pushBack(x, y, z);
        if (scan_.channels.empty()) return;
        [[maybe_unused]] std::size_t channel = 0;
        (scan_.channels[channel++].values.push_back(values), ...);
    }

 private:
    Scan& scan_;
};

}  // namespace hgmm::mrpt_bridge
