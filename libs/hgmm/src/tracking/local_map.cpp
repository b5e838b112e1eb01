#include "tracking/local_map.h"

#include "tracking/motion.h"

namespace hgmm {

namespace {

/// A new map takes over the scans of this share of its radius.
constexpr double kTakenOver = 0.25;
/// And no more of them: a sensor that turns in place goes no way [scans].
constexpr std::size_t kMostTakenOver = 300;

}  // namespace

bool LocalMap::hasMoved(const Pose& T_map_sensor) const {
    if (recent_.empty()) return true;
    const Pose& last = recent_.back().T_map_sensor;
    return (T_map_sensor.t - last.t).norm() >= params_.insertEvery_m ||
           rotationVector(last.R.transpose() * T_map_sensor.R).norm() >=
               params_.insertEvery_rad;
}

bool LocalMap::insert(const ScanSamples& samples, const Pose& T_map_sensor,
                      std::size_t number) {
    if (!hasMoved(T_map_sensor)) return false;
    if (recent_.empty())
        begin_ = T_map_sensor.t;
    else
        way_m_ += (T_map_sensor.t - recent_.back().T_map_sensor.t).norm();
    map_->insert(samples, T_map_sensor);
    recent_.push_back({samples, T_map_sensor, way_m_, number});
    while (way_m_ - recent_.front().way_m > kTakenOver * params_.mapRadius_m ||
           recent_.size() > kMostTakenOver)
        recent_.pop_front();
    if ((T_map_sensor.t - begin_).norm() > params_.mapRadius_m) beginAnew();
    return true;
}

void LocalMap::beginAnew() {
    map_ = std::make_shared<Map>(map_->params());
    begin_ = recent_.back().T_map_sensor.t;
    for (const Inserted& scan : recent_) map_->insert(scan.samples, scan.T_map_sensor);
}

void LocalMap::clear() {
    map_ = std::make_shared<Map>(map_->params());
    recent_.clear();
    way_m_ = 0.0;
}

}  // namespace hgmm
