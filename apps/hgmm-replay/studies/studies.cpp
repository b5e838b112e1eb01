#include "studies/studies.h"

#include <algorithm>

#include "format.h"
#include "map_setup.h"
#include "studies/comparison_studies.h"
#include "studies/dynamics_study.h"
#include "studies/fidelity_study.h"
#include "studies/free_space_study.h"
#include "studies/incremental_study.h"
#include "studies/landscape_study.h"
#include "studies/modality_study.h"
#include "studies/parked_study.h"
#include "studies/registration_study.h"
#include "studies/regression_study.h"
#include "studies/room_study.h"
#include "studies/unseen_study.h"
#include "studies/voxel_study.h"

namespace replay {
namespace {

using hgmm::evaluation::Recording;
using hgmm::evaluation::RecordingOptions;
using Needs = Study::Needs;

/// For studies that read a recording once.
template <class Run>
auto once(Run run) {
    return [run](Recording& recording, const RecordingOptions&, const Options& options) {
        run(recording, options);
    };
}

std::vector<Study> makeStudies() {
    return {
        {"fig3.2",
         "estimated size of each scan's mixture, and its divergence as it is reduced",
         Needs::scans,
         once([](Recording& recording, const Options& options) {
             fidelityStudy(recording, makeMap(options.config)->insertionOptions.params,
                           options);
         }),
         {}},
        {"fig3.5",
         "ROC of the surface model's likelihood against NDT at three cell sizes",
         Needs::testPoints,
         once(ndtStudy),
         {}},
        {"fig3.8",
         "voxels of 5 cm that each map holds occupied, as pictures",
         Needs::testPoints,
         once(voxelStudy),
         {}},
        {"incremental",
         "held-out likelihood of the map against mixtures of as many components fitted to "
         "all scans at once",
         Needs::testPoints,
         incrementalStudy,
         {}},
        {"fig4.1",
         "ROC of occupancy against OctoMap, NDT-OM and GPOctoMap",
         Needs::testPoints,
         once(occupancyStudy),
         {}},
        {"fig4.2",
         "accuracy, memory and divergence of the levels of the hierarchy",
         Needs::testPoints,
         once(levelsStudy),
         {}},
        {"table4.1",
         "memory against OctoMap, NDT-OM and GPOctoMap",
         Needs::posedScans,
         once(memoryStudy),
         {}},
        {"fig4.5",
         "variance of a noisy sine, by mixture and by Gaussian process; takes no LOG",
         Needs::nothing,
         {},
         regressionStudy},
        {"table5.1",
         "colours or intensity at held-out points, by maps of one scan and of all; colours "
         "inferred from each other",
         Needs::posedScans,
         once(modalityStudy),
         {}},
        {"realtime",
         "scans per second, from observation to updated map",
         Needs::posedScans,
         once(realtimeStudy),
         {}},
        {"free-space",
         "the map's free space beside the thesis' own, which is slow on large maps: "
         "begin with --to 50",
         Needs::testPoints,
         once(freeSpaceStudy),
         {}},
        {"room",
         "shares of right answers in a noiseless box room; add noise with --range-noise S",
         Needs::testScans,
         roomStudy,
         {}},
        {"dynamics",
         "how soon things that appear, move or go are noticed in a simulated room; takes "
         "no LOG",
         Needs::nothing,
         {},
         dynamicsStudy},
        {"parked",
         "whether the map of a robot that stays where it is grows, and a new wall is seen "
         "in it; takes no LOG",
         Needs::nothing,
         {},
         parkedStudy},
        {"unseen",
         "what is said of the insides of solids, of space behind walls, and where rays did "
         "not "
         "return; takes no LOG",
         Needs::nothing,
         {},
         unseenStudy},
        {"landscape",
         "whether the likelihood of test scans has its maximum at their poses, and hill "
         "climbing leads there",
         Needs::testScans,
         landscapeStudy,
         {}},
        {"landscape-local",
         "the same in maps of the three scans before and after each test scan only, for "
         "recordings whose poses drift",
         Needs::testScans,
         once(localLandscapeStudy),
         {}},
        {"registration",
         "pairs of scans aligned from guesses that are 0.5 m and 10 deg off",
         Needs::posedScans,
         once(registrationStudy),
         {}}};
}

const char* wordsFor(Needs needs) {
    switch (needs) {
        case Needs::testPoints:
            return "; needs --split K or --holdout-points F";
        case Needs::testScans:
            return "; needs --split K";
        case Needs::nothing:
        case Needs::scans:
        case Needs::posedScans:
            break;
    }
    return "";
}

}  // namespace

const std::vector<Study>& studies() {
    static const std::vector<Study> all = makeStudies();
    return all;
}

const Study* findStudy(const std::string& name) {
    const auto found = std::find_if(studies().begin(), studies().end(),
                                    [&](const Study& study) { return study.name == name; });
    return found == studies().end() ? nullptr : &*found;
}

std::string studyList() {
    std::string text;
    for (const Study& study : studies())
        text += format("%-15s ", study.name.c_str()) + study.text + wordsFor(study.needs) +
                "\n";
    return text;
}

}  // namespace replay
