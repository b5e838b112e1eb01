#pragma once
#include <optional>
#include <string>
#include <vector>

namespace localise {

struct Options {
    std::string mapFile;
    std::string log;  ///< "-": scans from stdin
    std::optional<std::string> sensorLabel;
    std::vector<double> start;  ///< x, y, z [m], yaw, pitch, roll [deg]; or empty
    std::string trajectory;     ///< file of poses; empty: none
    std::string table;          ///< file of rows; empty: none
    int threads = 0;            ///< 0: one for each core
    bool quiet = false;         ///< no rows on stdout
    bool force = false;

    bool readsStdin() const { return log == "-"; }
};

}  // namespace localise
