#include "hgmm/evaluation/figures.h"

#include <chrono>

#include "hgmm/divergence.h"
#include "hgmm/evaluation/likelihood.h"
#include "hgmm/map_params.h"

namespace hgmm::evaluation {

std::vector<LevelFigures> levelFigures(const Map& map) {
    std::vector<LevelFigures> figures;
    if (map.empty()) return figures;
    const Mixture<3>& base = map.mixture(0);
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        const Mixture<3>& mixture = map.mixture(level);
        LevelFigures& f = figures.emplace_back();
        f.level = level;
        f.components = mixture.size();
        f.bytes = parameterBytes(mixture);
        if (level > 0) f.klToLevel0 = klDivergence(base, mixture);
    }
    return figures;
}

MapFigures evaluateMap(const Map& map, const TestPoints& testPoints, std::uint64_t seed) {
    MapFigures figures;
    forEachField(map.params(), [&](const char* name, auto value) {
        figures.options.emplace_back(name, static_cast<double>(value));
    });
    figures.levels = levelFigures(map);
    figures.memory = memoryOf(map);
    if (map.empty() || testPoints.empty()) return figures;

    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    figures.logLikelihoodOfHits = heldOutLogLikelihood(
        [&](const Eigen::Vector3d& p_map) { return map.logDensity(p_map); },
        testPoints.hits());
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    figures.likelihoodsPerSecond = static_cast<double>(testPoints.hits().size()) / seconds;
    figures.reconstruction =
        compareSurfaces(sampleSurface(map.mixture(), map.origin(), kModelPoints, seed),
                        testPoints.reference());
    return figures;
}

}  // namespace hgmm::evaluation
