#include "studies/unseen_study.h"

#include <cstdio>

#include "hgmm/mrpt_bridge/output_file.h"
#include "interrupt.h"
#include "studies/unseen_hall.h"
#include "studies/unseen_solids.h"

namespace replay {

using namespace hgmm::evaluation;

void unseenStudy(const Options& options) {
    const StudyChoice& choice = options.choice;
    const auto parts = chosen("--only", choice.only, {"solids", "hall"});
    const auto sensors = chosen("--sensors", choice.sensors, {"2d", "16", "32", "camera"});
    const std::vector<int> scans =
        choice.after.empty() ? std::vector<int>{9, 75} : choice.after;
    const MakeMaps makeMaps = mapsOf(options);
    FigureTable solids = solidsTable(), hall = hallTable();
    std::vector<std::function<void()>> jobs;
    for (int i = 0; i < choice.seeds; ++i) {
        const std::uint64_t seed = options.split.seed + static_cast<std::uint64_t>(i);
        if (contains(parts, "solids"))
            for (const std::string& sensor : sensors)
                for (const auto route :
                     {solid_room::Route::round, solid_room::Route::through})
                    for (const int n : scans)
                        jobs.push_back([=, &makeMaps, &solids] {
                            studySolids(sensor, route, n, seed, makeMaps, solids);
                        });
        if (contains(parts, "hall"))
            for (const double limit_m : {10.0, 20.0})
                for (const auto noReturn :
                     {NoReturn::invalidZero, NoReturn::invalidMaxRange,
                      NoReturn::validMaxRange})
                    jobs.push_back([=, &makeMaps, &hall] {
                        studyHall(limit_m, noReturn, seed, makeMaps, hall);
                    });
    }
    std::printf("study unseen: worst of %d seeds\n", choice.seeds);
    runJobs(jobs, options.quiet);
    nlohmann::ordered_json json{{"study", "unseen"},
                                {"seeds", choice.seeds},
                                {"first_seed", options.split.seed},
                                {"interrupted", interrupted()}};
    for (const FigureTable* table : {&solids, &hall}) {
        if (table->empty()) continue;
        std::fputs(table->text().c_str(), stdout);
        json[table->key()] = table->json();
    }
    if (options.reportFolder)
        hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/metrics.json",
                                     json.dump(2) + "\n");
}

}  // namespace replay
