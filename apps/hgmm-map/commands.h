#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "hgmm/evaluation/render.h"

namespace maptool {

/// `hgmm-map info`: prints levels, size, extent, origin and options of a saved map.
void info(const std::string& mapFile);

struct SampleOptions {
    std::string mapFile, output;
    std::size_t points = 0;
    std::uint64_t seed = 1;
    std::size_t level = 0;
};

/// `hgmm-map sample`: draws points from a level into a PLY file.
void sample(const SampleOptions& options);

struct ExportOptions {
    std::string mapFile, output;
    std::string format;  ///< "ply", "3Dscene" or "png"
    std::size_t level = 0;
    std::size_t pointsPerComponent = 0;  ///< ply: points instead of ellipsoids, if not 0
    std::uint64_t seed = 1;
    hgmm::evaluation::View view;  ///< png only
};

/// `hgmm-map export`: ellipsoids at two sigma (or points) of one level, in the map frame.
void exportMap(const ExportOptions& options);

}  // namespace maptool
