#include "studies/dynamics_study.h"

#include <algorithm>
#include <cstdio>

#include "hgmm/mrpt_bridge/output_file.h"
#include "interrupt.h"
#include "studies/dynamics_protocols.h"
#include "studies/study_choice.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using changing_room::Background;

using Names = std::vector<std::string>;

const Names kProtocols{"removed", "appears", "person", "door"};
const Names kSensors{"2d", "16", "32", "camera"};

/// All that is to be run, as jobs, so that progress can be told.
using Job = std::function<void()>;

void addJobs(const std::string& protocol, const DynamicsRun& run,
             const std::vector<int>& after, std::vector<Job>& jobs) {
    const bool flat = run.sensor == "2d", camera = run.sensor == "camera";
    const auto scansOr = [&](std::vector<int> usual) {
        return after.empty() ? usual : after;
    };
    if (protocol == "removed" && !flat)
        for (const int n : scansOr({5, 50, 500}))
            jobs.push_back([=] { removedProtocol(run, n); });
    if (protocol == "appears" && !flat)
        for (const int n : scansOr({500})) jobs.push_back([=] { appearsProtocol(run, n); });
    if (protocol == "person")
        for (const int n : scansOr({20, 500})) {
            if (!flat) jobs.push_back([=] { personProtocol(run, n, Background::closed); });
            if (!camera) jobs.push_back([=] { personProtocol(run, n, Background::open); });
        }
    if (protocol == "door" && !flat)
        for (const double recess_m : {0.0, 0.11})
            jobs.push_back([=] { doorProtocol(run, recess_m); });
}

/// All tables in the order of kProtocols, then what stays.
std::vector<const FigureTable*> allOf(const DynamicsTables& t) {
    return {&t.removed, &t.appears, &t.person, &t.door, &t.stays};
}

void print(const FigureTable& table) {
    if (!table.empty()) std::fputs(table.text().c_str(), stdout);
    std::fflush(stdout);
}

void writeMetrics(const DynamicsTables& tables, const Options& options) {
    nlohmann::ordered_json json{{"study", "dynamics"},
                                {"seeds", options.choice.seeds},
                                {"first_seed", options.split.seed},
                                {"threads", options.threads},
                                {"interrupted", interrupted()}};
    for (const FigureTable* table : allOf(tables))
        if (!table->empty()) json[table->key()] = table->json();
    hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/metrics.json",
                                 json.dump(2) + "\n");
}

}  // namespace

void dynamicsStudy(const Options& options) {
    const Names protocols = chosen("--only", options.choice.only, kProtocols);
    const Names sensors = chosen("--sensors", options.choice.sensors, kSensors);
    const MakeMaps makeMaps = mapsOf(options);
    DynamicsTables tables;
    std::printf("study dynamics: worst of %d seeds, %d threads\n", options.choice.seeds,
                options.threads);
    for (const FigureTable* table : allOf(tables)) {
        std::vector<Job> jobs;
        for (const std::string& sensor : sensors)
            for (int i = 0; i < options.choice.seeds; ++i) {
                const std::uint64_t seed =
                    options.split.seed + static_cast<std::uint64_t>(i);
                if (contains(protocols, table->key()))
                    addJobs(table->key(), {sensor, seed, makeMaps, tables},
                            options.choice.after, jobs);
            }
        if (!interrupted()) runJobs(jobs, options.quiet || jobs.empty());
        print(*table);
    }
    if (options.reportFolder) writeMetrics(tables, options);
}

}  // namespace replay
