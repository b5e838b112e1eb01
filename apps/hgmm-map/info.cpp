#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "commands.h"
#include "hgmm/evaluation/memory.h"
#include "hgmm/params.h"
#include "load.h"

namespace maptool {
namespace {

/// Prints the box around all components, each reaching one sigma along every axis: two
/// would reach beyond the end of any flat surface.
void printExtent(const hgmm::Map& map) {
    const hgmm::Mixture<3>& base = map.mixture();
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float>& variance =
            base.covariance[hgmm::packedIndex(3, axis, axis)];
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = 0; i < base.size(); ++i) {
            const double reach = std::sqrt(static_cast<double>(variance[i]));
            low = std::min(low, static_cast<double>(base.mean[axis][i]) - reach);
            high = std::max(high, static_cast<double>(base.mean[axis][i]) + reach);
        }
        std::printf("extent %c    %.2f to %.2f m\n", "xyz"[axis], map.origin()[axis] + low,
                    map.origin()[axis] + high);
    }
}

void printModalities(const hgmm::Map& map) {
    if (map.modalities().empty()) return;
    std::printf("modality           components       bytes\n");
    for (const std::string& name : map.modalities()) {
        const hgmm::ModalityMap* modality = map.modality(name);
        std::printf("%-16s  %11zu  %10zu\n", name.c_str(), modality ? modality->size() : 0,
                    modality ? modality->savedBytes() : 0);
    }
}

}  // namespace

void info(const std::string& mapFile) {
    const mrpt::maps::CHGMMOccupancyMap loaded = loadMap(mapFile);
    const hgmm::Map& map = loaded.model();
    const hgmm::evaluation::Memory memory = hgmm::evaluation::memoryOf(map);
    std::printf("%s\n", mapFile.c_str());
    std::printf("serialised  %zu bytes, %zu bytes in memory\n",
                memory.serialized_bytes.value(), memory.live_bytes);
    if (map.empty()) {
        std::printf(map.coverageBytes() == 0
                        ? "the map is empty\n"
                        : "no surfaces, only space that rays passed\n");
    } else {
        std::printf("origin      %.0f %.0f %.0f m\n", map.origin().x() + 0.0,
                    map.origin().y() + 0.0,
                    map.origin().z() + 0.0);  // -0 is printed as such
        printExtent(map);
        std::printf("points      %.0f\n", map.mixture().totalSupport());
        std::printf("level     surface        free       bytes\n");
        for (std::size_t level = 0; level < map.levelCount(); ++level)
            std::printf("%5zu  %10zu  %10zu  %10zu\n", level, map.mixture(level).size(),
                        map.freeMixture(level).size(),
                        hgmm::evaluation::levelBytes(map, level));
        printModalities(map);
    }
    std::printf("options\n");
    hgmm::forEachNumber(map.params(), [](const hgmm::OptionRow& row, auto value) {
        std::printf("  %-16s %g\n", row.name, static_cast<double>(value));
    });
}

}  // namespace maptool
