#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/evaluation/memory.h"
#include "hgmm/evaluation/occupancy_figures.h"
#include "hgmm/evaluation/reconstruction.h"
#include "hgmm/evaluation/split.h"
#include "hgmm/evaluation/test_points.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/evaluation/unseen_points.h"

namespace hgmm::evaluation {

/// One level of a hierarchy (protocol, step 7).
struct LevelFigures {
    std::size_t level = 0;
    std::size_t components = 0;      ///< of the surface
    std::size_t componentsFree = 0;  ///< of free space
    std::size_t bytes = 0;    ///< components and coverage, saved compactly (levelBytes)
    double klToLevel0 = 0.0;  ///< KL(level 0 || this level) of the surface [nat], >= 0
    std::optional<double> aucUniform, aucNear;  ///< [0, 1]; none without test points
};

/// Everything measured on one map.
struct MapFigures {
    std::string name;
    std::string className;
    std::string source;                    ///< paper or library
    Meaning meaning = Meaning::occupancy;  ///< of its answers
    bool ranked = true;                    ///< whether it competes: its answers are
                                           ///< probabilities of occupancy
    std::vector<std::pair<std::string, double>> options;
    std::optional<OccupancyFigures> occupancy;  ///< none without test points
    std::optional<UnseenFigures> unseen;        ///< none for maps whose answers are no
                                                ///< probabilities
    std::optional<double> logLikelihoodOfHits;  ///< [nat/point]; none without test points
    std::optional<double> likelihoodsPerSecond;
    std::optional<Reconstruction> reconstruction;  ///< none without test points
    Memory memory;
    Timing scanTime_ms;             ///< of inserting alone
    std::vector<double> insert_ms;  ///< of each mapping scan, in order
    /// (mapping scans inserted, live bytes then), some 20 times over the run
    std::vector<std::pair<std::size_t, std::size_t>> liveBytesOverRun;
    std::vector<LevelFigures> levels;  ///< [0] is the base; none for other kinds of maps
};

/// What was run, and on what.
struct Run {
    std::string dataset;
    std::string sensor;  ///< MRPT class of the observations
    std::size_t scansMapped = 0;
    std::size_t scansTested = 0;
    double pointsPerScan = 0.0;  ///< mean over mapped and tested scans
    SplitParams split;
    std::size_t queriesPerScan = 0;
    NearBand nearBand;
    FreeBand freeBand;
    double rangeNoise_m = 0.0;  ///< added to mapping scans, one sigma [m]
    int threads = 1;
    bool interrupted = false;
};

/// Points drawn from the surface model to compare with the test scans.
constexpr std::size_t kModelPoints = 200000;

/// The figures of a map: all but its name and times of insertion. They are taken on the map
/// as loaded back from its saved bytes, for these are what is counted as its size; live
/// bytes are those of the map itself. What needs test points, or unseen ones, is left out
/// if there are none.
MapFigures evaluateMap(const Map& built, const TestPoints& testPoints, std::uint64_t seed,
                       const UnseenPoints& unseen = {});

/// The surface model of a map alone, as loaded back from its saved bytes: test points are
/// scored by its density, as thesis 3.4.1 does (Meaning::surfaceLikelihood).
MapFigures evaluateSurface(const Map& built, const TestPoints& testPoints);

/// The same for another kind of map.
MapFigures evaluateBaseline(const Baseline& baseline, const TestPoints& testPoints,
                            const UnseenPoints& unseen = {});

/// Points drawn from the base level to compare other levels with it: an error of .01 nat
/// where log-densities differ by 1 nat.
constexpr std::size_t kDivergencePoints = 10000;

/// The figures of the levels of a map; divergences by sampledKlDivergence.
std::vector<LevelFigures> levelFigures(const Map& map, const TestPoints& testPoints,
                                       std::uint64_t seed);

}  // namespace hgmm::evaluation
