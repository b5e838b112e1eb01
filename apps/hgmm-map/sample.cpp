#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "commands.h"
#include "hgmm/evaluation/ply.h"
#include "hgmm/evaluation/reconstruction.h"
#include "hgmm/mrpt_bridge/modality_colours.h"
#include "load.h"

namespace maptool {
namespace {

std::vector<hgmm::evaluation::Colour> coloursOf(const hgmm::Map& map,
                                                const hgmm::evaluation::Points& points_map,
                                                const std::string& file) {
    modalitiesOf(map, {""}, file);  // says what to do if there are none
    std::vector<hgmm::evaluation::Colour> colours;
    colours.reserve(points_map.size());
    const auto byte = [](float share) {
        return static_cast<std::uint8_t>(std::lround(255.F * share));
    };
    for (const auto& c : hgmm::mrpt_bridge::modalityColours(map, "", points_map))
        colours.push_back({byte(c.R), byte(c.G), byte(c.B)});
    return colours;
}

}  // namespace

void sample(const SampleOptions& options) {
    hgmm::mrpt_bridge::checkOutputs({{options.output, hgmm::mrpt_bridge::FileKind::ply}},
                                    {options.mapFile}, replaceFor(options.force));
    const mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    hgmm::evaluation::Ply ply;
    ply.vertices = hgmm::evaluation::sampleSurface(
        levelOf(map.model(), options.level, options.mapFile), map.model().origin(),
        options.points, options.seed);
    if (options.colour) ply.colours = coloursOf(map.model(), ply.vertices, options.mapFile);
    hgmm::evaluation::writePly(options.output, ply, replaceFor(options.force));
}

}  // namespace maptool
