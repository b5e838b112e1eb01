#include "studies/parked_study.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>

#include "format.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "interrupt.h"
#include "studies/figure_table.h"
#include "studies/notice.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using Worst = FigureColumn::Worst;

constexpr int kMarks[] = {10, 100, 1000, 4000};  ///< scans after which is counted
constexpr int kAt1000 = 2, kAtEnd = 4;           ///< of the counts, the end being the last
constexpr int kWithWall = 1000;                  ///< scans at the end
constexpr int kLeastScans = 1000 + kWithWall;

FigureTable parkedTable() {
    std::vector<FigureColumn> columns;
    const char* const scans[] = {"10", "100", "1000", "4000", "end"};
    for (const std::string kind : {"surface", "free"})
        for (const std::string n : scans)
            columns.push_back(
                {kind + " " + n, "components_" + kind + "_" + n, 0, Worst::largest});
    for (const std::string n : scans)
        columns.push_back({"KB " + n, "kilobytes_" + n, 1, Worst::largest});
    columns.push_back({"end/1000", "growth", 2, Worst::largest, "<=1.2"});
    columns.push_back({"wall half", "wall_scans_to_half", 0, Worst::largest});
    columns.push_back({"99 %", "wall_scans_to_99pct", 0, Worst::largest, "<=5"});
    columns.push_back({"ms/scan first tenth", "scan_ms_first_tenth", 2, Worst::largest});
    columns.push_back({"last", "scan_ms_last_tenth", 2, Worst::largest});
    return {"parked",
            "Parked: components, and scans until a new wall is occupied",
            {"sensor", "noise [cm]", "dust [%]", "map"},
            columns};
}

struct ParkedRun {
    std::string sensor;  ///< "2d" or "16"
    std::uint64_t seed;
    double noise_m, dustShare;
    int scans;  ///< >= kLeastScans
};

Observer parkedObserver(const ParkedRun& run) {
    Observer observer = observerOf(run.sensor);
    if (observer.planar) observer.sensor = planarLaser(361, observer.openingAngle_deg);
    observer.parked = true;
    observer.errors.noise_m = run.noise_m;
    observer.errors.dustShare = run.dustShare;
    return observer;
}

/// What is counted of a map after some scans.
struct Count {
    ComponentCount components;
    double kilobytes = 0.0;
};

/// The figures of a map from its counts, in the order of kMarks; one that was not taken is
/// nothing.
std::vector<double> figuresOf(const std::vector<std::optional<Count>>& counts,
                              const Notice& wall, std::size_t map,
                              const MapUnderTest& maps) {
    std::vector<double> figures;
    const auto add = [&](double (*figure)(const Count&)) {
        for (const std::optional<Count>& count : counts)
            figures.push_back(count ? figure(*count) : kNotTaken);
    };
    add([](const Count& c) { return double(c.components.surface); });
    add([](const Count& c) { return double(c.components.free); });
    add([](const Count& c) { return c.kilobytes; });
    const auto all = [](const Count& c) {
        return double(c.components.surface + c.components.free);
    };
    const double at1000 = all(*counts[kAt1000]);
    figures.push_back(at1000 > 0.0 ? all(*counts[kAtEnd]) / at1000 : kNotTaken);
    figures.push_back(wall.scansUntil(0.5, map));
    figures.push_back(wall.scansUntil(0.99, map));
    const Timing timing = summariseTimes(maps.insert_ms());
    figures.push_back(timing.firstTenth);
    figures.push_back(timing.lastTenth);
    return figures;
}

void park(const ParkedRun& run, const MakeMaps& makeMaps, FigureTable& table) {
    World world(parkedObserver(run), makeMaps, run.seed);
    const Scene before = changing_room::room(changing_room::Background::closed);
    Scene after = before;
    changing_room::addPartition(after);
    std::vector<std::vector<std::optional<Count>>> counts(world.maps().size());
    const auto count = [&] {
        for (std::size_t m = 0; m < counts.size(); ++m) {
            const MapUnderTest& map = *world.maps()[m];
            counts[m].push_back(
                Count{map.components(), static_cast<double>(map.savedBytes()) / 1000.0});
        }
    };
    for (const int mark : kMarks) {
        if (mark > run.scans - kWithWall) {
            for (auto& ofMap : counts) ofMap.emplace_back();
            continue;
        }
        world.show(before, mark - world.scans());
        count();
    }
    world.show(before, run.scans - kWithWall - world.scans());
    Notice wall(world, world.movingPoints(after, world.nextPose()), saysOccupied);
    for (int i = 0; i < kPatience && !interrupted(); ++i) {
        world.show(after);
        wall.look();
    }
    world.show(after, run.scans - world.scans());
    count();
    if (interrupted()) return;
    for (std::size_t m = 0; m < counts.size(); ++m) {
        const MapUnderTest& map = *world.maps()[m];
        table.add({run.sensor, format("%g", 100.0 * run.noise_m),
                   format("%g", 100.0 * run.dustShare), map.name()},
                  figuresOf(counts[m], wall, m, map));
    }
}

}  // namespace

void parkedStudy(const Options& options) {
    const StudyChoice& choice = options.choice;
    const auto parts = chosen("--only", choice.only, {"clean", "dust"});
    const auto sensors = chosen("--sensors", choice.sensors, {"2d", "16"});
    const std::vector<int> lengths =
        choice.after.empty() ? std::vector<int>{16000} : choice.after;
    const MakeMaps makeMaps = mapsOf(options);
    FigureTable table = parkedTable();
    std::vector<std::function<void()>> jobs;
    for (const std::string& sensor : sensors)
        for (const double noise_m : {0.01, 0.02})
            for (const auto& [part, dust] : {std::pair{"clean", 0.0}, {"dust", 0.005}}) {
                if (!contains(parts, part)) continue;
                for (const int n : lengths)
                    for (int i = 0; i < choice.seeds; ++i) {
                        const std::uint64_t seed =
                            options.split.seed + static_cast<std::uint64_t>(i);
                        const ParkedRun run{sensor, seed, noise_m, dust,
                                            std::max(n, kLeastScans)};
                        jobs.push_back(
                            [=, &makeMaps, &table] { park(run, makeMaps, table); });
                    }
            }
    std::printf("study parked: worst of %d seeds, %d threads\n", choice.seeds,
                options.threads);
    runJobs(jobs, options.quiet);
    if (!table.empty()) std::fputs(table.text().c_str(), stdout);
    if (!options.reportFolder) return;
    nlohmann::ordered_json json{{"study", "parked"},
                                {"seeds", choice.seeds},
                                {"first_seed", options.split.seed},
                                {"threads", options.threads},
                                {"interrupted", interrupted()}};
    if (!table.empty()) json[table.key()] = table.json();
    hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/metrics.json",
                                 json.dump(2) + "\n");
}

}  // namespace replay
