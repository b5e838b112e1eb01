#include "localisation/asked_poses.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <typeinfo>

namespace hgmm::mrpt_bridge {

AskedPoses& AskedPoses::ofProcess() {
    static AskedPoses asked;
    return asked;
}

MapFamily AskedPoses::newFamily() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {std::this_thread::get_id(), observations_};
}

LikelihoodKernel AskedPoses::kernelAt(const MapFamily& family, std::uint64_t map,
                                      const mrpt::obs::CObservation& observation,
                                      std::uint64_t digest, const Eigen::Vector3d& t_local,
                                      const Eigen::Matrix3d& R) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = std::find_if(asked_.begin(), asked_.end(), [&](const Asked& a) {
        return a.used > 0 && a.digest == digest && a.family == family;
    });
    Asked& asked = known != asked_.end() ? *known : start(family, observation, digest);
    asked.used = ++calls_;
    asked.byMap[map].add(t_local, R);
    return asked.kernel;
}

auto AskedPoses::start(const MapFamily& family, const mrpt::obs::CObservation& observation,
                       std::uint64_t digest) -> Asked& {
    Asked& oldest =
        *std::min_element(asked_.begin(), asked_.end(),
                          [](const Asked& a, const Asked& b) { return a.used < b.used; });
    Asked asked;
    asked.family = family;
    asked.digest = digest;
    asked.started = ++observations_;
    asked.sensor = observation.sensorLabel;
    asked.type = typeid(observation).hash_code();
    asked.stamp = observation.timestamp;
    const Asked* last = before(asked);
    asked.kernel = last ? kernelAfter(*last) : kernelFor(std::nullopt);
    oldest = std::move(asked);
    return oldest;
}

/// The observation of the same sensor that comes before, in time, for a log may start
/// anew; in the order of asking where there are no time stamps. Other sensors do not count:
/// each particle may be asked about all sensors in turn.
auto AskedPoses::before(const Asked& asked) const -> const Asked* {
    const bool hasStamp = asked.stamp != INVALID_TIMESTAMP;
    const Asked* last = nullptr;
    for (const Asked& other : asked_) {
        if (other.used == 0 || !(other.family == asked.family) ||
            other.type != asked.type || other.sensor != asked.sensor ||
            (hasStamp && other.stamp >= asked.stamp))
            continue;
        if (!last ||
            std::tie(last->stamp, last->started) < std::tie(other.stamp, other.started))
            last = &other;
    }
    return last;
}

LikelihoodKernel AskedPoses::kernelAfter(const Asked& before) {
    // Squared angles are rounded.
    constexpr double kSameAngle2 = 1e-4;
    const auto isOnePose = [](const auto& of) {
        const PoseSums& sums = of.second;
        return sums.squaredDistances() == 0 &&
               sums.squaredAngles() <= kSameAngle2 * double(sums.count());
    };
    const bool noneSearches =
        before.byMap.size() > 1 &&
        std::all_of(before.byMap.begin(), before.byMap.end(), isOnePose);
    return noneSearches ? kernelWithoutSearch() : kernelFor(spreadOf(before));
}

PoseSpread AskedPoses::spreadOf(const Asked& asked) {
    double poses = 0, squaredDistances = 0, squaredAngles = 0;
    for (const auto& [map, sums] : asked.byMap) {
        poses += double(sums.count());
        squaredDistances += sums.squaredDistances();
        squaredAngles += sums.squaredAngles();
    }
    if (poses == 0) return {};
    return {std::sqrt(squaredDistances / poses), std::sqrt(squaredAngles / poses)};
}

}  // namespace hgmm::mrpt_bridge
