#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/memory.h"
#include "hgmm/evaluation/reconstruction.h"
#include "hgmm/evaluation/split.h"
#include "hgmm/evaluation/test_points.h"
#include "hgmm/evaluation/timing.h"

namespace hgmm::evaluation {

/// One level of a hierarchy (protocol, step 7).
struct LevelFigures {
    std::size_t level = 0;
    std::size_t components = 0;
    std::size_t bytes = 0;    ///< parameters alone (parameterBytes)
    double klToLevel0 = 0.0;  ///< KL(level 0 || this level) [nat], 0 for level 0
};

/// Everything measured on one map.
struct MapFigures {
    std::string name;
    std::string className;
    std::vector<std::pair<std::string, double>> options;
    std::optional<double> logLikelihoodOfHits;  ///< [nat/point]; none without test points
    std::optional<double> likelihoodsPerSecond;
    std::optional<Reconstruction> reconstruction;  ///< none without test points
    Memory memory;
    Timing scanTime_ms;                ///< of inserting alone
    std::vector<LevelFigures> levels;  ///< [0] is the base
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
    int threads = 1;
    bool interrupted = false;
};

/// Points drawn from the surface model to compare with the test scans.
constexpr std::size_t kModelPoints = 200000;

/// The figures of a map that answers queries: all but its name and times of insertion.
/// Those that need test points are left out if there are none.
MapFigures evaluateMap(const Map& map, const TestPoints& testPoints, std::uint64_t seed);

/// The figures of the levels of a map. Goldberger's approximation compares each pair of
/// components once.
std::vector<LevelFigures> levelFigures(const Map& map);

}  // namespace hgmm::evaluation
