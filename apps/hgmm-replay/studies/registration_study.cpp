#include "studies/registration_study.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "hgmm/evaluation/registration_trials.h"
#include "map_setup.h"

namespace replay {

using namespace hgmm::evaluation;

void registrationStudy(Recording& recording, const Options& options) {
    const RegistrationTrials trials = trialsFor(recording.sensor(), options.split.seed);
    std::vector<std::unique_ptr<Aligner>> aligners;
    aligners.push_back(
        makeMixtureAligner(makeMap(options.config)->insertionOptions.params));
    const auto figures = runTrials(recording, aligners, trials);
    if (figures.front().errors.empty())
        throw std::runtime_error(options.log + ": no two scans are " +
                                 std::to_string(trials.gap) + " apart");
    std::printf("study registration: %s, %s",
                std::filesystem::path(options.log).stem().string().c_str(),
                trialsTable(figures, trials).c_str());
    std::puts(
        "  beside the NDT of PCL: bench-registration, built where libpcl-dev is installed");
}

}  // namespace replay
