#include "commands.h"
#include "hgmm/evaluation/reconstruction.h"
#include "load.h"
#include "ply.h"

namespace maptool {

void sample(const SampleOptions& options) {
    const mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    Ply ply;
    ply.vertices = hgmm::evaluation::sampleSurface(
        levelOf(map.model(), options.level, options.mapFile), map.model().origin(),
        options.points, options.seed);
    writePly(options.output, ply);
}

}  // namespace maptool
