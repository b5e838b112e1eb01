#include "studies/dynamics_protocols.h"

#include <cmath>
#include <limits>

#include "format.h"
#include "hgmm/evaluation/timing.h"
#include "interrupt.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using namespace hgmm::evaluation::changing_room;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kNotTaken = std::numeric_limits<double>::quiet_NaN();
constexpr int kPatience = 100;  ///< scans that a change may take to be noticed

using Say = bool (*)(const hgmm::Occupancy&);

/// How soon the maps of a world say of points what is so.
class Notice {
 public:
    Notice(const World& world, Points points_map, Say isRight)
        : world_(world), points_map_(std::move(points_map)), isRight_(isRight) {
        shares_.resize(world.maps().size());
    }

    /// After each scan since the change.
    void look() {
        for (std::size_t m = 0; m < shares_.size(); ++m)
            shares_[m].push_back(
                shareOf(world_.maps()[m]->occupancy(points_map_), isRight_));
    }
    /// Scans until at least this share was right.
    double scansUntil(double share, std::size_t map) const {
        for (std::size_t i = 0; i < shares_[map].size(); ++i)
            if (shares_[map][i] >= share) return static_cast<double>(i + 1);
        return points_map_.empty() ? kNotTaken : kNever;
    }
    bool allNoticed(double share) const {
        for (std::size_t m = 0; m < shares_.size(); ++m)
            if (!std::isfinite(scansUntil(share, m))) return points_map_.empty();
        return true;
    }
    double first(std::size_t map) const { return shares_[map].front(); }
    double last(std::size_t map) const { return shares_[map].back(); }
    double points() const { return static_cast<double>(points_map_.size()); }

 private:
    const World& world_;
    Points points_map_;
    Say isRight_;
    std::vector<std::vector<double>> shares_;  ///< of each map after each scan
};

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

void showFor(World& world, const Scene& scene, int scans) {
    for (int i = 0; i < scans && !interrupted(); ++i) world.show(scene);
}

double medianTime(const MapUnderTest& map) {
    return median(map.insert_ms());
}

/// A change from one scene to another, both with the same thing or without.
void changeProtocol(const DynamicsRun& run, int scans, bool appears) {
    World world(observerOf(run.sensor), run.makeMaps, run.seed);
    const Scene without = room(Background::closed);
    Scene with = without;
    addBox(with);
    showFor(world, appears ? without : with, scans);
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
    showFor(world, empty, scans);
    Staying staying(world, empty);
    Walk walk(world);
    for (int i = 0; i < kScans && !interrupted(); ++i) {
        Scene scene = empty;
        addPerson(scene, personAt(i));
        world.show(scene);
        walk.look(world, world.movingPoints(scene, world.lastPose()));
    }
    Notice trail(world, walk.trail_map, saysOccupied);
    showFor(world, empty, kSoon);
    trail.look();
    showFor(world, empty, kLater - kSoon);
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
    showFor(world, shut, kShutFirst);
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

void parkedProtocol(const DynamicsRun& run, double noise_m, double dustShare, int scans) {
    constexpr int kWithWall = 1000;  // scans at the end
    const int marks[] = {10, 100, 1000};
    Observer observer = observerOf(run.sensor);
    observer.parked = true;
    observer.errors.noise_m = noise_m;
    observer.errors.dustShare = dustShare;
    World world(observer, run.makeMaps, run.seed);
    const Scene before = room(Background::closed);
    Scene after = before;
    addPartition(after);
    std::vector<std::vector<ComponentCount>> counts(world.maps().size());
    const auto count = [&] {
        for (std::size_t m = 0; m < counts.size(); ++m)
            counts[m].push_back(world.maps()[m]->components());
    };
    for (const int mark : marks) {
        showFor(world, before, mark - world.scans());
        count();
    }
    showFor(world, before, scans - kWithWall - world.scans());
    Notice wall(world, world.movingPoints(after, world.nextPose()), saysOccupied);
    for (int i = 0; i < kWithWall && !interrupted(); ++i) {
        world.show(after);
        if (i < kPatience) wall.look();
    }
    count();
    if (interrupted()) return;
    for (std::size_t m = 0; m < counts.size(); ++m) {
        const auto all = [](const ComponentCount& c) { return double(c.surface + c.free); };
        std::vector<double> figures;
        for (const ComponentCount& c : counts[m]) figures.push_back(double(c.surface));
        for (const ComponentCount& c : counts[m]) figures.push_back(double(c.free));
        const double at1000 = all(counts[m][2]);
        figures.push_back(at1000 > 0.0 ? all(counts[m][3]) / at1000 : kNotTaken);
        figures.push_back(wall.scansUntil(0.5, m));
        figures.push_back(wall.scansUntil(0.99, m));
        figures.push_back(medianTime(*world.maps()[m]));
        run.tables.parked.add({run.sensor, format("%g", 100.0 * noise_m),
                               format("%g", 100.0 * dustShare), world.maps()[m]->name()},
                              figures);
    }
}

}  // namespace replay
