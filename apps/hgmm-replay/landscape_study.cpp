#include "landscape_study.h"

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "format.h"
#include "hgmm/evaluation/metrics_json.h"
#include "hgmm/evaluation/pose_landscape.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "interrupt.h"
#include "map_setup.h"
#include "progress.h"
#include "replay_scans.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using hgmm::Pose;

constexpr double kOff_m = 0.3, kOff_deg = 5.0;     // of the search, and of climbs' starts
constexpr double kNear_m = 0.05, kNear_deg = 0.5;  // of what counts as found
constexpr int kClimbsPerScan = 5;

/// What one test scan's likelihood led to.
struct ScanLandscape {
    std::size_t scan = 0;
    PoseError highest;  ///< of the maximum
    double highestOverTruth =
        0.0;  ///< by how much it is above the value at the truth [nat]
    std::vector<PoseError> climbed;  ///< where each climb ended
};

bool found(const PoseError& error) {
    return error.position_m <= kNear_m && error.rotation_deg <= kNear_deg;
}

/// Half of the scan's points are farther.
double medianRange(const hgmm::Scan& scan) {
    std::vector<double> ranges;
    for (std::size_t i = 0; i < scan.size(); ++i)
        ranges.push_back(std::hypot(scan.x[i], scan.y[i], scan.z[i]));
    return median(std::move(ranges));
}

ScanLandscape explore(const mrpt::maps::CHGMMOccupancyMap& map,
                      const RecordedScan& recorded, const hgmm::Scan& scan,
                      const Options& options) {
    const bool planar = IS_CLASS(*recorded.observation, mrpt::obs::CObservation2DRangeScan);
    PoseSearch search;
    search.planar = planar;
    search.lever_m = std::max(0.1, medianRange(scan));
    search.firstStep_m = planar ? 0.05 : 0.15;
    const PoseScore score = [&](const Pose& T_map_robot) {
        return map.computeObservationLikelihood(*recorded.observation,
                                                hgmm::mrpt_bridge::toCPose3D(T_map_robot));
    };
    const Pose truth = hgmm::mrpt_bridge::toPose(recorded.T_map_robot);
    auto stream = randomStream(options.split.seed, recorded.index, Draw::startPose);

    ScanLandscape result;
    result.scan = recorded.index;
    const Pose highest = highestAround(score, truth, kOff_m, kOff_deg, search, stream);
    result.highest = errorOf(highest, truth);
    result.highestOverTruth = score(highest) - score(truth);
    search.firstStep_m = 0.1;
    for (int k = 0; k < kClimbsPerScan; ++k)
        result.climbed.push_back(errorOf(
            climb(score, displaced(truth, kOff_m, kOff_deg, planar, stream), search),
            truth));
    return result;
}

std::string medians(const std::vector<PoseError>& errors) {
    std::vector<double> metres, degrees;
    for (const PoseError& error : errors) {
        metres.push_back(error.position_m);
        degrees.push_back(error.rotation_deg);
    }
    return format("%.4f of %zu; median error %.3f m, %.2f deg",
                  double(std::count_if(errors.begin(), errors.end(), found)) /
                      double(std::max<std::size_t>(1, errors.size())),
                  errors.size(), median(metres), median(degrees));
}

std::string summary(const Run& run, const std::vector<ScanLandscape>& scans) {
    std::vector<PoseError> highest, climbed;
    for (const ScanLandscape& scan : scans) {
        highest.push_back(scan.highest);
        climbed.insert(climbed.end(), scan.climbed.begin(), scan.climbed.end());
    }
    std::string text = format("study landscape: %s, %zu scans mapped, %zu tested\n",
                              run.dataset.c_str(), run.scansMapped, scans.size());
    text += format("  within %g m, %g deg of the true pose:\n", kNear_m, kNear_deg);
    text += format("  maximum within %g m, %g deg      ", kOff_m, kOff_deg) +
            medians(highest) + "\n";
    return text + format("  climbs from %g m, %g deg away    ", kOff_m, kOff_deg) +
           medians(climbed) + "\n";
}

std::string csv(const std::vector<ScanLandscape>& scans) {
    std::string text =
        "scan,maximum_off_m,maximum_off_deg,maximum_over_truth_nat,climbs_that_return\n";
    for (const ScanLandscape& scan : scans)
        text += format("%zu,%.4f,%.3f,%.3f,%td\n", scan.scan, scan.highest.position_m,
                       scan.highest.rotation_deg, scan.highestOverTruth,
                       std::count_if(scan.climbed.begin(), scan.climbed.end(), found));
    return text;
}

}  // namespace

void landscapeStudy(Recording& recording, const RecordingOptions& recordingOptions,
                    const Options& options) {
    const Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (replayed.map->model().empty())
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    std::vector<ScanLandscape> scans;
    Recording again(options.log, recordingOptions);
    Progress progress(replayed.run.scansTested, options.quiet);
    while (const auto recorded = again.next()) {
        if (interrupted()) break;
        if (!options.split.isTestScan(recorded->index)) continue;
        const auto scan = hgmm::mrpt_bridge::observationToScan(*recorded->observation);
        if (scan && scan->size() > 0)
            scans.push_back(explore(*replayed.map, *recorded, *scan, options));
        progress.advance();
    }
    if (scans.empty()) throw std::runtime_error(options.log + ": no scan was left to test");
    std::fputs(summary(replayed.run, scans).c_str(), stdout);
    if (options.reportFolder)
        writeTextFile(*options.reportFolder + "/landscape.csv", csv(scans));
}

}  // namespace replay
