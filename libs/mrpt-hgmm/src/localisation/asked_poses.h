#pragma once
#include <mrpt/obs/CObservation.h>

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "localisation/likelihood_kernel.h"

namespace hgmm::mrpt_bridge {

/// Maps that may be those of one filter's particles: made, cleared or loaded by one thread
/// without a likelihood asked for in between, and the copies of such maps.
struct MapFamily {
    std::thread::id thread;
    std::uint64_t observationsBefore = 0;  ///< that any map was asked about [count]

    bool operator==(const MapFamily& o) const {
        return thread == o.thread && observationsBefore == o.observationsBefore;
    }
};

/// The poses that maps were asked about at the last observations, for all maps of the
/// process, because each particle of a filter may have a map of its own. Decides the kernel
/// of an observation when a family of maps is asked about it for the first time, from the
/// spread of the poses at the observation before. So the kernel is one for all poses of an
/// observation, whatever their order and thread, as long as no thread goes on to the next
/// observation before the others are done with this one. Memory is bounded. Thread-safe.
class AskedPoses {
 public:
    static AskedPoses& ofProcess();

    /// A family without past for a map made now by this thread.
    MapFamily newFamily();

    /// The kernel for an observation; notes a pose that is asked about.
    /// @param map number of the map, of its own: spreads are those within a map's poses
    /// @param digest the observation's (digestOf)
    LikelihoodKernel kernelAt(const MapFamily& family, std::uint64_t map,
                              const mrpt::obs::CObservation& observation,
                              std::uint64_t digest, const Eigen::Vector3d& t_local,
                              const Eigen::Matrix3d& R);

 private:
    struct Asked {
        MapFamily family;
        std::uint64_t digest = 0, started = 0, used = 0;  ///< counts of calls; 0: no entry
        std::string sensor;
        std::size_t type = 0;
        mrpt::Clock::time_point stamp;
        LikelihoodKernel kernel{};
        std::map<std::uint64_t, PoseSums> byMap;
    };

    Asked& start(const MapFamily& family, const mrpt::obs::CObservation& observation,
                 std::uint64_t digest);
    const Asked* before(const Asked& asked) const;
    /// The kernel that follows from what was asked at the observation before.
    static LikelihoodKernel kernelAfter(const Asked& before);
    static PoseSpread spreadOf(const Asked& asked);

    std::mutex mutex_;
    std::array<Asked, 32> asked_;
    std::uint64_t observations_ = 0, calls_ = 0;
};

}  // namespace hgmm::mrpt_bridge
