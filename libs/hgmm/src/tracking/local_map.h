#pragma once
#include <deque>
#include <memory>

#include "hgmm/map.h"
#include "hgmm/scan.h"
#include "hgmm/tracker.h"

namespace hgmm {

/// The map that odometry builds: bounded, for a new one begins where the sensor has gone
/// far, with the scans of the last part of the way.
class LocalMap {
 public:
    LocalMap(const MapParams& mapParams, const TrackerParams& params)
        : params_(params), map_(std::make_shared<Map>(mapParams)) {}

    const std::shared_ptr<Map>& map() const { return map_; }

    /// Enters a scan if the sensor has moved or turned enough since the last one that was.
    /// @param number of the scan, rising
    bool insert(const ScanSamples& samples, const Pose& T_map_sensor, std::size_t number);
    void clear();

    /// All but the samples of scans (StateWriter, StateReader).
    template <typename Archive>
    void archive(Archive& a) {
        a(*map_, begin_, way_m_);
        a.each(recent_,
               [&](Inserted& scan) { a(scan.number, scan.T_map_sensor, scan.way_m); });
    }
    /// @param samplesOfScan tells those of a number, asked for in rising order
    template <typename SamplesOfScan>
    void bringSamples(const SamplesOfScan& samplesOfScan) {
        for (Inserted& scan : recent_) scan.samples = samplesOfScan(scan.number);
    }

 private:
    struct Inserted {
        ScanSamples samples;
        Pose T_map_sensor;
        double way_m = 0.0;      ///< that the sensor had come
        std::size_t number = 0;  ///< of the scan
    };

    bool hasMoved(const Pose& T_map_sensor) const;
    void beginAnew();

    TrackerParams params_;
    std::shared_ptr<Map> map_;
    std::deque<Inserted> recent_;                      ///< the last at the end
    Eigen::Vector3d begin_ = Eigen::Vector3d::Zero();  ///< where the map began [m]
    double way_m_ = 0.0;
};

}  // namespace hgmm
