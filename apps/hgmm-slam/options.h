#pragma once
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

namespace hgmm::slam_app {

/// The command line.
struct Options {
    std::string log;
    std::string folder;                      ///< of all outputs
    std::optional<std::string> config;       ///< of the map
    std::optional<std::string> earlier;      ///< map to go on from, or its folder
    std::optional<std::string> odometry;     ///< poses of another program
    std::optional<std::string> sensorLabel;  ///< none: the only one, or the first
    bool ignoreOdometry = false;             ///< of the recording
    std::size_t from = 0;
    std::size_t to = std::numeric_limits<std::size_t>::max();
    double saveEvery_s = 30.0;  ///< between states that an interrupted run goes on from
    bool restart = false;       ///< whatever state there is
    int threads = 0;            ///< 0 = one per core
    bool force = false;
    bool quiet = false;
};

}  // namespace hgmm::slam_app
