#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "hgmm/map.h"
#include "hgmm/slam/closure.h"
#include "hgmm/slam/earlier_map.h"
#include "hgmm/slam/pose_graph.h"
#include "hgmm/slam/submap.h"

namespace hgmm::slam {

/// What odometry does not say of its own errors: a random walk.
struct DriftParams {
    double shiftPerMetre = 0.02;  ///< after 1 m, one sigma; grows with the root [m], > 0
    double turnPerMetre_rad = 0.003;  ///< the same of the rotation [rad], > 0
    double turnPerTurn = 0.01;        ///< share of a turn [1], > 0

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

struct SlamParams {
    SubmapParams submap;
    DriftParams drift;
    ClosureParams closure;
    OptimisationParams optimisation;
    EarlierMapParams earlier;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// Whether a session was found in an earlier map, and by how much.
struct Continuation {
    bool found = false;
    std::size_t searched = 0;  ///< submaps that were looked for everywhere [count]
    std::size_t agreeing =
        0;  ///< of these, found where they lie as in this session [count]
    std::size_t elsewhere = 0;  ///< that agree on another place just as well [count]
};

/// Simultaneous localisation and mapping behind an odometry: scans make submaps
/// (hgmm::Map), finished submaps are compared with older ones, and what is found to be the
/// same place moves the submaps, whose maps stay as they are, until a map is asked for.
///
/// Closures are looked for on a thread of their own while the next submap is made, and
/// enter the graph when that one is finished: the result is the same for any number of
/// threads. Memory grows with the map, and with a pose a scan.
class SubmapSlam {
 public:
    /// Throws std::invalid_argument for params out of range.
    explicit SubmapSlam(const MapParams& map = {}, const SlamParams& params = {});
    ~SubmapSlam();
    SubmapSlam(const SubmapSlam&) = delete;
    SubmapSlam& operator=(const SubmapSlam&) = delete;

    /// Inserts one more scan.
    /// @param scan samplesOf(scan, params of the map), which odometry may share
    /// @param T_robot_sensor where the sensor is on the robot
    /// @param T_previous_robot how the robot moved since the last scan that was inserted,
    /// as odometry has it; of no meaning for the first one. Where it is a mere guess
    /// (isGuess), a submap begins.
    /// Throws std::invalid_argument for a pose that is not finite or not rigid,
    /// a covariance that is not finite, and
    /// std::logic_error after finish().
    void add(const ScanSamples& scan, const Pose& T_robot_sensor,
             const UncertainPose& T_previous_robot);

    /// Notes where the robot was at a scan of which nothing is recognised; the scan is not
    /// inserted.
    /// @param T_previous_robot how the robot may have moved since the last scan that was
    /// Throws as add does.
    void addLost(const UncertainPose& T_previous_robot);

    /// Waits for closures, and closes the submap at hand: what is asked below is final.
    void finish();

    /// Looks for this session in the map of an earlier one, after finish(). Where it is
    /// found, its frame becomes the world, and the earlier map, which stays as it is, a
    /// part of the fused map: node 0 of the graph, and other nodes are one further on. All
    /// submaps that show the same as it become closures. Where it is not, or in several
    /// places, nothing changes.
    /// Throws std::logic_error before finish() or when one was found before, and
    /// std::invalid_argument for a null or empty map.
    Continuation continueFrom(std::shared_ptr<const Map> earlier);

    /// @name Going on in another process
    /// Scans that follow give the same result there, bit for bit.
    /// @{

    /// Submaps that do not change any more, but for their poses.
    std::size_t finishedSubmaps() const;
    /// The state, between two scans, without finished submaps. For the same version of the
    /// library. Throws std::logic_error after finish().
    std::vector<std::uint8_t> save() const;
    /// Finished submap k. Throws std::out_of_range.
    std::vector<std::uint8_t> saveSubmap(std::size_t k) const;
    /// Takes over a state that another object of the same parameters saved, in place of
    /// this one's.
    /// @param submapOf tells what saveSubmap(k) was
    /// Throws FormatError for another buffer, and what submapOf throws; nothing is changed
    /// then.
    void load(const std::vector<std::uint8_t>& state,
              const std::function<std::vector<std::uint8_t>(std::size_t k)>& submapOf);
    /// @}

    /// Where the robot was at each scan, as is known now.
    std::vector<Pose> trajectory() const;
    /// Where the robot is.
    Pose T_world_robot() const;
    /// Nodes are submaps, behind the earlier map if there is one.
    const PoseGraph& graph() const;
    /// Closures that are in the graph.
    std::size_t closures() const;
    std::size_t submaps() const;
    /// Groups of submaps that only guesses hold together: 1 if the map is one [count].
    std::size_t parts() const;
    /// All submaps merged as they lie now (Map::merge), into the earlier map if there is
    /// one.
    Map fusedMap() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hgmm::slam
