#include "studies/study_choice.h"

#include <algorithm>
#include <stdexcept>

#include "interrupt.h"
#include "map_setup.h"
#include "progress.h"

namespace replay {

using namespace hgmm::evaluation;

MakeMaps mapsOf(const Options& options) {
    const hgmm::MapParams params = makeMap(options.config)->insertionOptions.params;
    return [params, names = options.baselines] {
        std::vector<std::unique_ptr<MapUnderTest>> maps;
        maps.push_back(oursUnderTest(params));
        for (const std::string& name : names)
            maps.push_back(baselineUnderTest(name, SensorKind::depthCamera));
        return maps;
    };
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> chosen(const char* option, const std::vector<std::string>& wanted,
                                const std::vector<std::string>& known) {
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    for (const std::string& name : wanted)
        if (!contains(known, name))
            throw std::invalid_argument(std::string(option) + ": " + name + " is none of " +
                                        all);
    return wanted.empty() ? known : wanted;
}

void runJobs(const std::vector<std::function<void()>>& jobs, bool quiet) {
    catchInterrupts();
    Progress progress(jobs.size(), quiet);
    for (const auto& job : jobs) {
        job();
        if (interrupted()) return;
        progress.advance();
    }
}

}  // namespace replay
