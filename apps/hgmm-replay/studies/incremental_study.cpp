#include "studies/incremental_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "hgmm/evaluation/likelihood.h"
#include "hgmm/evaluation/range_noise.h"
#include "hgmm/gaussian.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "hgmm/scan.h"
#include "interrupt.h"
#include "map_setup.h"
#include "progress.h"
#include "replay_scans.h"
#include "studies/batch_fit.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

/// Leaves that the pool has room for, at least: EM passes over so many in half a second.
constexpr std::size_t kPoolCapacity = 200000;

/// Samples per component, at least, for which the pool has room.
constexpr std::size_t kSamplesPerComponent = 20;

/// The filtered samples of the mapping scans, in the map's local frame.
SamplePool poolSamples(Recording& recording, const hgmm::Map& map, const Options& options) {
    const hgmm::FilterParams& filter = map.params().filter;
    SamplePool pool(filter.minLeaf_m,
                    std::max(kPoolCapacity, kSamplesPerComponent * map.mixture().size()));
    Progress progress(recording.size(), options.quiet);
    while (const auto recorded = recording.next()) {
        if (interrupted()) break;
        progress.advance();
        if (options.split.isTestScan(recorded->index)) continue;
        auto scan = hgmm::mrpt_bridge::observationToScan(*recorded->observation,
                                                         recorded->T_map_robot);
        if (!scan) continue;
        hgmm::Scan mapping =
            splitPoints(std::move(*scan), recorded->index, options.split).mapping;
        if (options.rangeNoise_m > 0.0)
            addRangeNoise(mapping, options.rangeNoise_m, options.split.seed,
                          recorded->index);
        const hgmm::Pose T_local_sensor{mapping.T_map_sensor.R,
                                        mapping.T_map_sensor.t - map.origin()};
        pool.add(hgmm::transformed(hgmm::samplesOf(mapping, map.params()).samples_sensor,
                                   T_local_sensor));
    }
    return pool;
}

/// Of hits under a mixture in the local frame, components farther than kReachSigmas being
/// left out as in hgmm::Map::logDensity.
double logLikelihoodOf(const hgmm::Mixture<3>& mixture, const Eigen::Vector3d& origin,
                       const Points& hits_map) {
    std::vector<hgmm::WhitenedGaussian<3>> factors;
    for (std::size_t j = 0; j < mixture.size(); ++j) factors.emplace_back(mixture[j]);
    const double logTotal = std::log(mixture.totalSupport());
    const auto logDensity = [&](const Eigen::Vector3d& point_map) {
        const Eigen::Vector3d p = point_map - origin;
        double density = -std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < factors.size(); ++j)
            if (factors[j].isWithin(p.data(), hgmm::kReachSigmas * hgmm::kReachSigmas))
                density = hgmm::logAddExp(density, std::log(double(mixture.support[j])) +
                                                       factors[j].logPdf(p.data()));
        return density - logTotal;
    };
    return heldOutLogLikelihood(logDensity, hits_map);
}

IncrementalComparison compare(const hgmm::Map& map, const SamplePool& pool,
                              const Points& hits_map) {
    const hgmm::Mixture<3>& base = map.mixture();
    const hgmm::Mixture<3> samples = pool.samples();
    IncrementalComparison result{{}, samples.size(), pool.edge_m()};
    const auto add = [&](const char* model, const hgmm::Mixture<3>& mixture) {
        result.models.push_back(
            {model, mixture.size(), logLikelihoodOf(mixture, map.origin(), hits_map)});
    };
    add("incremental map", base);
    if (interrupted()) return result;
    add("batch EM from cells",
        batchFit(samples, batchGuess(pool, base.size(), map.params().hierarchy),
                 base.size()));
    if (interrupted()) return result;
    add("batch EM from the map", batchFit(samples, base, base.size()));
    return result;
}

std::string summary(const IncrementalComparison& comparison, const Run& run,
                    std::size_t hits) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "study incremental: %zu scans mapped, %zu tested, %zu held-out hits; batch "
        "models see %zu samples (leaves of %.3g m)\n",
        run.scansMapped, run.scansTested, hits, comparison.samples, comparison.leaf_m);
    std::string text = line;
    text += "model                   components   nat/point   over the incremental map\n";
    const double reference = comparison.models.front().logLikelihood;
    for (const ModelLikelihood& m : comparison.models) {
        std::snprintf(line, sizeof line, "%-22s  %10zu  %10.4f  %+10.4f\n", m.model.c_str(),
                      m.components, m.logLikelihood, m.logLikelihood - reference);
        text += line;
    }
    return text;
}

std::string csv(const IncrementalComparison& comparison) {
    std::ostringstream out;
    out << "model,components,loglik_hit_nat,over_incremental_nat\n";
    const double reference = comparison.models.front().logLikelihood;
    for (const ModelLikelihood& m : comparison.models)
        out << m.model << ',' << m.components << ',' << m.logLikelihood << ','
            << m.logLikelihood - reference << '\n';
    return out.str();
}

}  // namespace

void incrementalStudy(Recording& recording, const RecordingOptions& recordingOptions,
                      const Options& options) {
    const Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (comparisonStopped()) return;
    const hgmm::Map& map = replayed.map->model();
    const Points& hits_map = replayed.testPoints.hits();
    if (map.empty())
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    if (hits_map.empty())
        throw std::runtime_error(options.log +
                                 ": no test points were held out for study incremental");
    Recording again(options.log, recordingOptions);
    const SamplePool pool = poolSamples(again, map, options);
    if (comparisonStopped()) return;
    const IncrementalComparison comparison = compare(map, pool, hits_map);
    if (comparisonStopped()) return;
    std::fputs(summary(comparison, replayed.run, hits_map.size()).c_str(), stdout);
    if (options.reportFolder)
        hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/incremental.csv",
                                     csv(comparison));
}

}  // namespace replay
