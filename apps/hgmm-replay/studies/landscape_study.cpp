#include "studies/landscape_study.h"

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "format.h"
#include "hgmm/evaluation/pose_landscape.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "hgmm/registration.h"
#include "hgmm/scan.h"
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
constexpr int kClimbsPerScan = 20;
constexpr std::size_t kNeighbours = 3;  // before and after a test scan

/// What one test scan's likelihood led to, and how far that is from two poses: the
/// recording's, which may be wrong, and the one to which registration of all points of the
/// scan moves it.
struct ScanLandscape {
    std::size_t scan = 0;
    PoseError registered;           ///< from the recording's pose to the registered one
    double highestOverTruth = 0.0;  ///< value of the maximum over that at the truth [nat]
    struct Found {
        PoseError toRecorded, toRegistered;
    };
    Found highest;
    std::vector<Found> climbed;
};

bool isNear(const PoseError& error) {
    return error.position_m <= kNear_m && error.rotation_deg <= kNear_deg;
}

/// A search for a pose that places what the map would learn of a scan, which is in the
/// robot's frame.
PoseSearch searchFor(const hgmm::Scan& scan, const hgmm::FilterParams& filter,
                     bool planar) {
    const hgmm::Mixture<3> samples_sensor = hgmm::filterScan(scan, filter);
    PoseSearch search;
    search.planar = planar;
    std::vector<double> ranges;
    for (std::size_t i = 0; i < samples_sensor.size(); ++i) {
        const Eigen::Vector3d mean = samples_sensor[i].mean;
        ranges.push_back(mean.norm());
        search.pivot += (scan.T_map_sensor.R * mean + scan.T_map_sensor.t) /
                        double(samples_sensor.size());
    }
    search.lever_m = ranges.empty() ? 0.1 : std::max(0.1, median(std::move(ranges)));
    return search;
}

/// T_map_robot after alignment of all points of a scan with the map.
Pose registeredPose(const hgmm::Map& map, const hgmm::RegistrationTarget& target,
                    const hgmm::Scan& scan, const Pose& T_map_robot) {
    const hgmm::Mixture<3> source =
        hgmm::transformed(hgmm::filterScan(scan, map.params().filter), scan.T_map_sensor);
    const hgmm::Registration found =
        target.align(source, {T_map_robot.R, T_map_robot.t - map.origin()});
    return {found.T_target_source.R, found.T_target_source.t + map.origin()};
}

/// Looks at the likelihoods of test scans in one map.
class Explorer {
 public:
    Explorer(const mrpt::maps::CHGMMOccupancyMap& map, std::uint64_t seed)
        : map_(map), seed_(seed), target_({&map.model().mixture()}, fineOnly()) {}

    /// @param scan in the robot's frame
    ScanLandscape explore(const RecordedScan& recorded, const hgmm::Scan& scan) const {
        const bool planar =
            IS_CLASS(*recorded.observation, mrpt::obs::CObservation2DRangeScan);
        PoseSearch search = searchFor(scan, map_.model().params().filter, planar);
        search.firstStep_m = planar ? 0.05 : std::clamp(0.05 * search.lever_m, 0.1, 0.3);
        const PoseScore score = [&](const Pose& T_map_robot) {
            return map_.computeObservationLikelihood(
                *recorded.observation, hgmm::mrpt_bridge::toCPose3D(T_map_robot));
        };
        const Pose truth = hgmm::mrpt_bridge::toPose(recorded.T_map_robot);
        const Pose registered = registeredPose(map_.model(), target_, scan, truth);
        const auto found = [&](const Pose& pose) {
            return ScanLandscape::Found{errorOf(pose, truth), errorOf(pose, registered)};
        };
        auto stream = randomStream(seed_, recorded.index, Draw::startPose);

        ScanLandscape result;
        result.scan = recorded.index;
        result.registered = errorOf(registered, truth);
        const Pose highest = highestAround(score, truth, kOff_m, kOff_deg, search, stream);
        result.highest = found(highest);
        result.highestOverTruth = score(highest) - score(truth);
        search.firstStep_m = 0.1;
        for (int k = 0; k < kClimbsPerScan; ++k)
            result.climbed.push_back(found(
                climb(score, displaced(truth, kOff_m, kOff_deg, planar, stream), search)));
        return result;
    }

 private:
    /// The pose that it starts from is nearly right.
    static hgmm::RegistrationParams fineOnly() {
        hgmm::RegistrationParams params;
        params.coarseWidth_m = 0.1;
        params.coarseAngle_rad = 0.03;
        return params;
    }

    const mrpt::maps::CHGMMOccupancyMap& map_;
    std::uint64_t seed_;
    hgmm::RegistrationTarget target_;
};

std::string row(const char* what, const std::vector<PoseError>& errors) {
    std::vector<double> metres, degrees;
    for (const PoseError& error : errors) {
        metres.push_back(error.position_m);
        degrees.push_back(error.rotation_deg);
    }
    return format("  %-44s %6zu  %6.3f  %8.3f m  %8.2f deg\n", what, errors.size(),
                  double(std::count_if(errors.begin(), errors.end(), isNear)) /
                      double(std::max<std::size_t>(1, errors.size())),
                  median(metres), median(degrees));
}

std::string summary(const std::string& title, const std::vector<ScanLandscape>& scans) {
    std::vector<PoseError> highest, highestRegistered, climbed, climbedRegistered, moved;
    for (const ScanLandscape& scan : scans) {
        highest.push_back(scan.highest.toRecorded);
        highestRegistered.push_back(scan.highest.toRegistered);
        moved.push_back(scan.registered);
        for (const ScanLandscape::Found& end : scan.climbed) {
            climbed.push_back(end.toRecorded);
            climbedRegistered.push_back(end.toRegistered);
        }
    }
    std::string text = format("%s, %zu tested\n", title.c_str(), scans.size());
    text += format("maxima are sought, and climbs start, up to %g m and %g deg away\n",
                   kOff_m, kOff_deg);
    text +=
        format("  %-44s  count  within %g m, %g deg; medians\n", "", kNear_m, kNear_deg);
    text += row("maximum, from the recording's pose", highest);
    text += row("climbs, from the recording's pose", climbed);
    text += row("registration, from the recording's pose", moved);
    text += row("maximum, from the registered pose", highestRegistered);
    return text + row("climbs, from the registered pose", climbedRegistered);
}

std::string csv(const std::vector<ScanLandscape>& scans) {
    std::string text =
        "scan,maximum_off_m,maximum_off_deg,maximum_over_truth_nat,registered_off_m,"
        "registered_off_deg,climbs_that_return\n";
    for (const ScanLandscape& scan : scans)
        text += format(
            "%zu,%.4f,%.3f,%.3f,%.4f,%.3f,%td\n", scan.scan,
            scan.highest.toRecorded.position_m, scan.highest.toRecorded.rotation_deg,
            scan.highestOverTruth, scan.registered.position_m, scan.registered.rotation_deg,
            std::count_if(scan.climbed.begin(), scan.climbed.end(),
                          [](const auto& end) { return isNear(end.toRecorded); }));
    return text;
}

/// Prints what was found, and writes it where a report is wanted.
void report(const std::string& title, const std::vector<ScanLandscape>& scans,
            const Options& options) {
    if (scans.empty()) throw std::runtime_error(options.log + ": no scan was left to test");
    std::fputs(summary(title, scans).c_str(), stdout);
    if (options.reportFolder)
        hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/landscape.csv", csv(scans));
}

void exploreScan(const Explorer& explorer, const RecordedScan& recorded,
                 std::vector<ScanLandscape>& scans) {
    const auto scan = hgmm::mrpt_bridge::observationToScan(*recorded.observation);
    if (scan && scan->size() > 0) scans.push_back(explorer.explore(recorded, *scan));
}

/// A map whose likelihoods do not follow the spread of the poses that the study asks about,
/// unless the configuration fixes them: they are those that a converged filter gets.
std::shared_ptr<mrpt::maps::CHGMMOccupancyMap> mapToExplore(const Options& options) {
    constexpr double kConvergedWidth_m = 0.02;
    auto map = makeMap(options.config);
    auto& likelihood = map->likelihoodOptions;
    const bool followsSpread = likelihood.kernelWidth_m == 0 &&
                               likelihood.outlierRatio == 0 &&
                               likelihood.independentPoints == 0;
    if (followsSpread) likelihood.kernelWidth_m = kConvergedWidth_m;
    return map;
}

/// Looks at scan `index` in a map of the others.
void exploreAmong(const std::deque<RecordedScan>& window, std::size_t index,
                  const Options& options, std::vector<ScanLandscape>& scans) {
    const auto map = mapToExplore(options);
    const RecordedScan* tested = nullptr;
    for (const RecordedScan& recorded : window) {
        if (recorded.index == index)
            tested = &recorded;
        else if (recorded.index + kNeighbours >= index)
            map->insertObservation(*recorded.observation, recorded.T_map_robot);
    }
    if (tested != nullptr && !map->model().empty())
        exploreScan(Explorer(*map, options.split.seed), *tested, scans);
}

}  // namespace

void landscapeStudy(Recording& recording, const RecordingOptions& recordingOptions,
                    const Options& options) {
    const Replayed replayed = replayScans(recording, mapToExplore(options), options);
    if (replayed.map->model().empty())
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    const Explorer explorer(*replayed.map, options.split.seed);
    std::vector<ScanLandscape> scans;
    Recording again(options.log, recordingOptions);
    Progress progress(replayed.run.scansTested, options.quiet);
    while (const auto recorded = again.next()) {
        if (interrupted()) break;
        if (!options.split.isTestScan(recorded->index)) continue;
        exploreScan(explorer, *recorded, scans);
        progress.advance();
    }
    report(format("study landscape: %s, %zu scans mapped", replayed.run.dataset.c_str(),
                  replayed.run.scansMapped),
           scans, options);
}

void localLandscapeStudy(Recording& recording, const Options& options) {
    std::deque<RecordedScan> window;
    std::deque<std::size_t> waiting;  // test scans whose last neighbours are to come
    std::vector<ScanLandscape> scans;
    Progress progress(recording.size(), options.quiet);
    while (auto recorded = recording.next()) {
        if (interrupted()) break;
        const std::size_t index = recorded->index;
        window.push_back(std::move(*recorded));
        if (window.front().index + 2 * kNeighbours < index) window.pop_front();
        if (options.split.isTestScan(index)) waiting.push_back(index);
        if (!waiting.empty() && waiting.front() + kNeighbours <= index) {
            exploreAmong(window, waiting.front(), options, scans);
            waiting.pop_front();
        }
        progress.advance();
    }
    for (const std::size_t index : waiting)
        if (!interrupted()) exploreAmong(window, index, options, scans);
    report(format("study landscape-local: %s, each scan in a map of up to %zu scans before "
                  "and %zu after it",
                  options.log.c_str(), kNeighbours, kNeighbours),
           scans, options);
}

}  // namespace replay
