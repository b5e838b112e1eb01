#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "hgmm/evaluation/free_points.h"
#include "hgmm/evaluation/split.h"

namespace replay {

/// What of a study to run.
struct StudyChoice {
    std::vector<std::string> only;     ///< its parts; none: all
    std::vector<std::string> sensors;  ///< simulated ones; none: all
    std::vector<int> after;            ///< scans before a change; none: the usual ones [1]
    int seeds = 1;                     ///< runs, whose seeds count from --seed on [1]
};

/// The command line.
struct Options {
    std::string log;
    std::optional<std::string> config;
    std::optional<std::string> poses;
    std::optional<std::string> reportFolder;
    std::optional<std::string> saveMap;
    bool force = false;  ///< replace a file in the place of saveMap that is no map
    std::optional<std::string> study;
    StudyChoice choice;
    hgmm::evaluation::SplitParams split;
    double rangeNoise_m = 0.0;  ///< added to mapping scans, one sigma [m]
    std::optional<hgmm::evaluation::NearBand> near;  ///< none = by the kind of sensor
    hgmm::evaluation::FreeBand free;
    std::vector<std::string> baselines;  ///< as makeBaseline takes them
    std::size_t from = 0;
    std::size_t to = std::numeric_limits<std::size_t>::max();
    int threads = 0;  ///< 0 = one per core
    bool quiet = false;
    bool count = false;  ///< say how many scans there are, and nothing else
};

}  // namespace replay
