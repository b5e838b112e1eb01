#include <cstdio>
#include <stdexcept>

#include "commands.h"
#include "load.h"

namespace maptool {

void forget(const ForgetOptions& options) {
    const std::vector<double>& b = options.box;
    if (b.size() != 6)
        throw std::runtime_error("--box: must be six numbers x0,y0,z0,x1,y1,z1");
    hgmm::mrpt_bridge::checkOutputs({{options.output, hgmm::mrpt_bridge::FileKind::map}},
                                    {options.mapFile}, replaceFor(options.force));
    mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    std::size_t forgotten = 0;
    try {
        forgotten = map.model().forget(
            {Eigen::Vector3d(b[0], b[1], b[2]), Eigen::Vector3d(b[3], b[4], b[5])});
    } catch (const std::invalid_argument&) {
        throw std::runtime_error(
            "--box: must be finite, its first corner below its second");
    }
    std::printf("components  %zu forgotten, %zu stay\n", forgotten,
                map.model().mixture().size());
    map.saveToFile(options.output, options.force);
}

}  // namespace maptool
