#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/changing_room.h"
#include "hgmm/evaluation/map_under_test.h"
#include "hgmm/evaluation/simulated_sensor.h"
#include "studies/study_choice.h"

namespace replay {

/// Who looks, and how.
struct Observer {
    hgmm::evaluation::SimulatedSensor sensor;
    double openingAngle_deg = 360.0;  ///< of a planar laser [deg]
    double sway_rad = 0.0;  ///< of the yaw about +x [rad]; 0: it turns with the path
    bool planar =
        false;  ///< scans become observations of MRPT and are converted by default
    bool parked = false;  ///< stays in the middle instead of going round
    hgmm::evaluation::RangeErrors errors;
};

/// The sensors of the study by name: "2d", "16", "32" and "camera". Throws
/// std::invalid_argument, listing the names, for another.
Observer observerOf(const std::string& name);

/// A robot in a room that changes, and the maps that it makes. It goes round on a circle of
/// .5 m, 200 scans a turn, with its sensor 1 m above the floor.
class World {
 public:
    World(const Observer& observer, const MakeMaps& makeMaps, std::uint64_t seed);

    /// Takes the next scan, of a scene as it is now, for all maps.
    void show(const hgmm::evaluation::Scene& scene);

    /// The next scans, until Ctrl-C.
    void show(const hgmm::evaluation::Scene& scene, int scans);

    /// Where the last scan was taken, and where the next will be.
    hgmm::Pose lastPose() const { return poseOf(scans_ - 1); }
    hgmm::Pose nextPose() const { return poseOf(scans_); }

    /// Up to `n` points of the moving thing as a sensor without errors sees them, but those
    /// within 12 cm of what stays [m, map frame].
    hgmm::evaluation::Points movingPoints(const hgmm::evaluation::Scene& scene,
                                          const hgmm::Pose& T_map_sensor,
                                          std::size_t n = 800) const;

    const std::vector<std::unique_ptr<hgmm::evaluation::MapUnderTest>>& maps() const {
        return maps_;
    }
    const Observer& observer() const { return observer_; }
    int scans() const { return scans_; }
    std::uint64_t seed() const { return seed_; }
    /// Up to `n` of the points, seeded.
    template <class T>
    std::vector<T> draw(const std::vector<T>& all, std::size_t n) const {
        std::vector<T> drawn;
        for (const std::size_t i : indices(all.size(), n)) drawn.push_back(all[i]);
        return drawn;
    }

 private:
    hgmm::Pose poseOf(int scan) const;
    std::vector<std::size_t> indices(std::size_t total, std::size_t n) const;

    Observer observer_;
    std::vector<std::unique_ptr<hgmm::evaluation::MapUnderTest>> maps_;
    std::uint64_t seed_;
    double start_;  ///< share of the circle [1], in [0, 1)
    int scans_ = 0;
};

/// Surfaces that stay, in classes: points that the robot sees from where it is.
class StayingPoints {
 public:
    static constexpr int kClasses = 5;
    static const char* nameOf(int kind);

    /// @param scene with the moving thing, whose neighbourhood of 12 cm is left out
    StayingPoints(const World& world, const hgmm::evaluation::Scene& scene);

    /// Share of each class that a map says is occupied [1]; NaN for a class that is not
    /// seen.
    std::vector<double> occupiedShares(const hgmm::evaluation::MapUnderTest& map) const;

 private:
    hgmm::evaluation::Points points_[kClasses];  ///< [m, map frame]
};

}  // namespace replay
