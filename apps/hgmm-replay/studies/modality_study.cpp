#include "studies/modality_study.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "hgmm/evaluation/split.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "interrupt.h"
#include "map_setup.h"
#include "progress.h"
#include "studies/modality_report.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using Clock = std::chrono::steady_clock;
using Names = std::vector<std::string>;

constexpr std::size_t kSingleScans = 10;
constexpr std::size_t kTestPointsOfRun = 200000, kTestPointsOfScan = 20000;

bool hasChannel(const hgmm::Scan& scan, const std::string& name) {
    return std::any_of(scan.channels.begin(), scan.channels.end(),
                       [&](const hgmm::Channel& c) { return c.name == name; });
}

/// Those of the configuration, else what the sensor measures.
Names modalitiesOf(const hgmm::Scan& scan, const Names& configured) {
    if (!configured.empty()) return configured;
    if (hasChannel(scan, "r")) return {"r", "g", "b"};
    if (hasChannel(scan, "intensity")) return {"intensity"};
    return {};
}

std::vector<std::size_t> allOf(const hgmm::Scan& scan) {
    std::vector<std::size_t> indices(scan.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    return indices;
}

/// The maps, and what is learnt about them scan by scan.
class ModalityTrial {
 public:
    ModalityTrial(const Recording& recording, const Options& options)
        : options_(options), scansInAll_(recording.size()) {
        findings_.run.dataset = std::filesystem::path(options.log).stem().string();
        findings_.run.sensor = recording.sensor();
        findings_.run.split = options.split;
        findings_.run.split.every = 0;
        if (findings_.run.split.holdoutPoints == 0.0)
            findings_.run.split.holdoutPoints = kModalityHoldout;
        findings_.run.threads = options.threads;
        plain_ = makeMap(options.config);
        coloured_ = makeMap(options.config);
        plain_->insertionOptions.params.modalities.clear();
    }

    void add(hgmm::Scan scan, std::size_t scanIndex) {
        if (findings_.names.empty() && !chooseNames(scan)) return;
        const SplitScan parts = splitPoints(scan, scanIndex, findings_.run.split);
        insertTimed(parts.mapping);
        sampleTestPoints(parts.heldOut, scanIndex);
        const std::size_t n = findings_.run.scansMapped++;
        points_ += scan.size();
        // Every scan of a short recording, else evenly spaced ones.
        const std::size_t spacing = std::max<std::size_t>(1, scansInAll_ / kSingleScans);
        if (n % spacing == spacing / 2) studyScan(parts, scanIndex);
        if (n == scansInAll_ / 2) middle_ = std::move(scan);
    }

    /// @throws std::runtime_error if there was nothing to learn.
    const ModalityFindings& finish() {
        Run& run = findings_.run;
        if (test_.size() == 0)
            throw std::runtime_error(
                options_.log +
                ": has neither colours nor intensities, or not those that --config names");
        run.pointsPerScan = double(points_) / double(run.scansMapped);
        const hgmm::Map map = savedAndLoaded(coloured_->model());
        estimates_ = estimatesAt(map, test_);
        findings_.sequence = evaluateModalities(map, test_, estimates_);
        if (test_.names.size() > 1)
            findings_.query_us =
                inferAt(map, shuffled(test_, run.split.seed), test_.names.size() - 1)
                    .query_us;
        return findings_;
    }
    void markInterrupted() { findings_.run.interrupted = true; }

    hgmm::mrpt_bridge::ReadingParams& reading() {
        return coloured_->insertionOptions.reading;
    }

    /// The scan in the middle by a map of its own, in its sensor's frame.
    ModalityView viewOfScan() const {
        hgmm::Scan scan = middle_;
        scan.T_map_sensor = {};
        return viewOf(mapOf(scan), scan);
    }
    /// Test points of all scans by the map of all; after finish().
    ModalityView viewOfSequence() const { return {test_, estimates_}; }

 private:
    bool chooseNames(const hgmm::Scan& scan) {
        findings_.names = modalitiesOf(scan, coloured_->insertionOptions.params.modalities);
        coloured_->insertionOptions.params.modalities = findings_.names;
        test_.names = findings_.names;
        return !findings_.names.empty();
    }

    /// Who goes first finds colder caches: they take turns.
    void insertTimed(const hgmm::Scan& mapping) {
        const bool colouredFirst = findings_.run.scansMapped % 2 == 0;
        for (const bool first : {true, false}) {
            const bool coloured = first == colouredFirst;
            const Clock::time_point start = Clock::now();
            (coloured ? coloured_ : plain_)->insertScan(mapping);
            const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
            (coloured ? findings_.insertWith_ms : findings_.insertWithout_ms)
                .push_back(taken.count());
        }
    }

    void sampleTestPoints(const hgmm::Scan& heldOut, std::size_t scanIndex) {
        const std::size_t most = std::max<std::size_t>(100, kTestPointsOfRun / scansInAll_);
        appendMeasured(heldOut,
                       chooseIndices(heldOut.size(), most, findings_.run.split.seed,
                                     scanIndex, Draw::modalityQueries),
                       test_);
    }

    hgmm::Map mapOf(const hgmm::Scan& mapping) const {
        const auto map = makeMap(options_.config);
        map->insertionOptions.params.modalities = findings_.names;
        map->insertScan(mapping);
        return savedAndLoaded(map->model());
    }

    void studyScan(const SplitScan& parts, std::size_t scanIndex) {
        ModalityPoints test{findings_.names, {}, {}};
        appendMeasured(
            parts.heldOut,
            chooseIndices(parts.heldOut.size(), kTestPointsOfScan, findings_.run.split.seed,
                          scanIndex, Draw::modalityQueries),
            test);
        if (test.size() == 0) return;
        const hgmm::Map map = mapOf(parts.mapping);
        ModalityMapResult result = evaluateModalities(map, test, estimatesAt(map, test));
        result.scan = scanIndex;
        if (findings_.names.size() > 1) {
            const std::uint64_t seed = findings_.run.split.seed;
            const ModalityPoints queries = shuffled(test, seed);
            for (std::size_t target = 0; target < findings_.names.size(); ++target) {
                hgmm::Scan poor = parts.mapping;
                keepShare(poor, findings_.names[target], kPoorShare, seed, scanIndex);
                result.crossModal.push_back(inferAt(mapOf(poor), queries, target));
            }
        }
        findings_.scans.push_back(result);
    }

    ModalityView viewOf(const hgmm::Map& map, const hgmm::Scan& scan) const {
        ModalityView view{{findings_.names, {}, {}}, {}};
        appendMeasured(scan, allOf(scan), view.points);
        view.estimates = estimatesAt(map, view.points);
        return view;
    }

    const Options& options_;
    std::size_t scansInAll_;
    std::size_t points_ = 0;
    mrpt::maps::CHGMMOccupancyMap::Ptr coloured_, plain_;
    ModalityPoints test_;
    ModalityEstimates estimates_;  // at test_, by the map of all scans
    hgmm::Scan middle_;
    ModalityFindings findings_;
};

void writeModalityReport(const ModalityTrial& study, const ModalityFindings& findings,
                         const Options& options) {
    const SensorKind sensor = sensorKindOf(findings.run.sensor);
    std::vector<PointPicture> pictures;
    const auto add = [&](const ModalityView& shown, const std::string& name,
                         const View& view) {
        for (auto& made : {reconstructionPictures(shown, name, view),
                           deviationPictures(shown, name, view)})
            pictures.insert(pictures.end(), made.begin(), made.end());
    };
    add(study.viewOfSequence(), "table5.1", reportView(sensor));
    const ModalityView scan = study.viewOfScan();
    // As the camera sees it.
    if (sensor == SensorKind::depthCamera && scan.points.size() > 0)
        add(scan, "table5.1_scan", {0.0, 0.0, 0.0});
    writeReportFiles(modalityMetrics(findings), options, pictures);
}

}  // namespace

void modalityStudy(Recording& recording, const Options& options) {
    ModalityTrial study(recording, options);
    Progress progress(recording.size(), options.quiet);
    while (const auto recorded = recording.next()) {
        hgmm::mrpt_bridge::settleIntensityScale(*recorded->observation, study.reading());
        auto scan = hgmm::mrpt_bridge::observationToScan(
            *recorded->observation, recorded->T_map_robot, hgmm::mrpt_bridge::Channels::all,
            study.reading());
        if (scan) study.add(std::move(*scan), recorded->index);
        progress.advance();
        if (!interrupted()) continue;
        study.markInterrupted();
        break;
    }
    const ModalityFindings& findings = study.finish();
    std::fputs(modalityTable(findings).c_str(), stdout);
    if (options.reportFolder) writeModalityReport(study, findings, options);
}

}  // namespace replay
