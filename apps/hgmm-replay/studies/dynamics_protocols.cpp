#include "studies/dynamics_protocols.h"

#include "hgmm/evaluation/timing.h"
#include "interrupt.h"
#include "studies/notice.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using namespace hgmm::evaluation::changing_room;

/// Shares of what stays, before and after a change.
class Staying {
 public:
    Staying(const World& world, const Scene& scene) : points_(world, scene) {
        for (const auto& map : world.maps())
            before_.push_back(points_.occupiedShares(*map));
    }

    void report(const std::string& protocol, const DynamicsRun& run, const World& world) {
        for (std::size_t m = 0; m < before_.size(); ++m) {
            const MapUnderTest& map = *world.maps()[m];
            std::vector<double> shares = before_[m];
            for (const double share : points_.occupiedShares(map)) shares.push_back(share);
            run.tables.stays.add({protocol, run.sensor, map.name()}, shares);
        }
    }

 private:
    StayingPoints points_;
    std::vector<std::vector<double>> before_;  ///< of each map
};

double medianTime(const MapUnderTest& map) {
    return median(map.insert_ms());
}

/// A change from one scene to another, both with the same thing or without.
void changeProtocol(const DynamicsRun& run, int scans, bool appears) {
    World world(observerOf(run.sensor), run.makeMaps, run.seed);
    const Scene without = room(Background::closed);
    Scene with = without;
    addBox(with);
    world.show(appears ? without : with, scans);
    Staying staying(world, with);
    Notice notice(world,
                  world.movingPoints(with, appears ? world.nextPose() : world.lastPose()),
                  appears ? saysOccupied : saysFree);
    for (int i = 0; i < kPatience && !notice.allNoticed(0.99) && !interrupted(); ++i) {
        world.show(appears ? with : without);
        notice.look();
    }
    if (interrupted()) return;
    FigureTable& table = appears ? run.tables.appears : run.tables.removed;
    for (std::size_t m = 0; m < world.maps().size(); ++m)
        table.add({run.sensor, std::to_string(scans), world.maps()[m]->name()},
                  {notice.scansUntil(0.5, m), notice.scansUntil(0.99, m), notice.first(m),
                   notice.last(m), notice.points(), medianTime(*world.maps()[m])});
    staying.report((appears ? "appears " : "removed ") + std::to_string(scans), run, world);
}

/// A person's points: how they were answered after their own scan, and its trail.
struct Walk {
    explicit Walk(const World& world) : right(world.maps().size(), 0.0) {}

    void look(const World& world, const Points& points_map) {
        constexpr std::size_t kTrailPerScan = 50;
        for (std::size_t m = 0; m < right.size(); ++m)
            right[m] += shareOf(world.maps()[m]->occupancy(points_map), saysOccupied) *
                        static_cast<double>(points_map.size());
        points += static_cast<double>(points_map.size());
        for (const auto& p_map : world.draw(points_map, kTrailPerScan))
            trail_map.push_back(p_map);
    }

    std::vector<double> right;  ///< of each map, points [1]
    double points = 0.0;        ///< all [1]
    Points trail_map;           ///< [m]
};

}  // namespace

void removedProtocol(const DynamicsRun& run, int scans) {
    changeProtocol(run, scans, false);
}

void appearsProtocol(const DynamicsRun& run, int scans) {
    changeProtocol(run, scans, true);
}

void personProtocol(const DynamicsRun& run, int scans, Background background) {
    constexpr int kScans = 300, kSoon = 1, kLater = 20;
    World world(observerOf(run.sensor), run.makeMaps, run.seed);
    const Scene empty = room(background);
    world.show(empty, scans);
    Staying staying(world, empty);
    Walk walk(world);
    for (int i = 0; i < kScans && !interrupted(); ++i) {
        Scene scene = empty;
        addPerson(scene, personAt(i));
        world.show(scene);
        walk.look(world, world.movingPoints(scene, world.lastPose()));
    }
    Notice trail(world, walk.trail_map, saysOccupied);
    world.show(empty, kSoon);
    trail.look();
    world.show(empty, kLater - kSoon);
    trail.look();
    if (interrupted()) return;
    const std::string behind = background == Background::open ? "open" : "closed";
    for (std::size_t m = 0; m < world.maps().size(); ++m)
        run.tables.person.add(
            {run.sensor, behind, std::to_string(scans), world.maps()[m]->name()},
            {walk.right[m] / walk.points, trail.first(m), trail.last(m),
             medianTime(*world.maps()[m])});
    staying.report("person " + std::to_string(scans) + " " + behind, run, world);
}

void doorProtocol(const DynamicsRun& run, double recess_m) {
    constexpr int kShutFirst = 50, kSwings = 8, kSwing = 30;
    World world(observerOf(run.sensor), run.makeMaps, run.seed);
    const Scene open = room(Background::closed);
    Scene shut = open;
    addDoor(shut, recess_m);
    world.show(shut, kShutFirst);
    Staying staying(world, shut);
    const std::string name = recess_m > 0.0 ? "recessed" : "flush";
    for (int swing = 0; swing < kSwings && !interrupted(); ++swing) {
        const bool opens = swing % 2 == 0;
        Notice notice(world, world.movingPoints(shut, world.nextPose()),
                      opens ? saysFree : saysOccupied);
        for (int i = 0; i < kSwing; ++i) {
            world.show(opens ? open : shut);
            notice.look();
        }
        for (std::size_t m = 0; m < world.maps().size(); ++m) {
            const double scans = notice.scansUntil(0.9, m);
            run.tables.door.add(
                {run.sensor, name, world.maps()[m]->name()},
                {opens ? scans : kNotTaken, opens ? kNotTaken : scans,
                 opens ? notice.last(m) : kNotTaken, medianTime(*world.maps()[m])});
        }
    }
    staying.report("door " + name, run, world);
}

}  // namespace replay
