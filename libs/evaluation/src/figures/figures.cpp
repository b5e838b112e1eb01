#include "hgmm/evaluation/figures.h"

#include <chrono>
#include <cmath>

#include "hgmm/divergence.h"
#include "hgmm/evaluation/likelihood.h"
#include "hgmm/params.h"

namespace hgmm::evaluation {

namespace {

/// None where no free point was drawn: a rate needs both classes.
std::optional<OccupancyFigures> occupancyOf(const BatchQuery& query,
                                            const TestPoints& testPoints) {
    if (testPoints.uniformFree().points_map.empty() ||
        testPoints.nearFree().points_map.empty())
        return std::nullopt;
    return evaluateOccupancy(query, testPoints);
}

}  // namespace

std::vector<LevelFigures> levelFigures(const Map& map, const TestPoints& testPoints,
                                       std::uint64_t seed) {
    std::vector<LevelFigures> figures;
    if (map.empty()) return figures;
    const Mixture<3>& base = map.mixture(0);
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        const Mixture<3>& mixture = map.mixture(level);
        LevelFigures& f = figures.emplace_back();
        f.level = level;
        f.components = mixture.size();
        f.componentsFree = map.freeMixture(level).size();
        f.bytes = levelBytes(map, level);
        if (level > 0)
            f.klToLevel0 =
                sampledKlDivergence(base, mixture, kDivergencePoints, seed).value;
        if (const auto occupancy = occupancyOf(queryOf(map, level), testPoints)) {
            f.aucUniform = occupancy->aucUniform;
            f.aucNear = occupancy->aucNear;
        }
    }
    return figures;
}

MapFigures evaluateMap(const Map& built, const TestPoints& testPoints, std::uint64_t seed,
                       const UnseenPoints& unseen) {
    const std::vector<std::uint8_t> saved = built.save();
    const Map map = Map::load(saved.data(), saved.size());
    MapFigures figures;
    figures.source = "this project; docs/method.md";
    forEachNumber(map.params(), [&](const OptionRow& row, auto value) {
        figures.options.emplace_back(row.name, static_cast<double>(value));
    });
    figures.levels = levelFigures(map, testPoints, seed);
    figures.memory = memoryOf(built);
    if (!map.empty() && !unseen.free_map.empty())
        figures.unseen = evaluateUnseen(occupancyQueryOf(map), unseen);
    if (map.empty() || testPoints.empty()) return figures;
    figures.occupancy = occupancyOf(queryOf(map), testPoints);

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

MapFigures evaluateSurface(const Map& built, const TestPoints& testPoints) {
    const std::vector<std::uint8_t> saved = built.save();
    const Map map = Map::load(saved.data(), saved.size());
    MapFigures figures;
    figures.source = "this project; docs/method.md";
    figures.meaning = Meaning::surfaceLikelihood;
    figures.ranked = false;
    figures.memory = memoryOf(built);
    figures.occupancy = occupancyOf(
        [&](const Eigen::Vector3d* points_map, std::size_t n, Answer* answers) {
            for (std::size_t i = 0; i < n; ++i) {
                // Any rising function of the density ranks alike; this one stays in [0, 1].
                const double odds = std::exp(map.logDensity(points_map[i]));
                answers[i] = {std::isfinite(odds) ? odds / (odds + 1.0) : 1.0, false};
            }
        },
        testPoints);
    return figures;
}

MapFigures evaluateBaseline(const Baseline& baseline, const TestPoints& testPoints,
                            const UnseenPoints& unseen) {
    MapFigures figures;
    figures.className = baseline.className();
    figures.source = baseline.source();
    figures.meaning = baseline.meaning();
    figures.ranked = figures.meaning == Meaning::occupancy;
    figures.options = baseline.options();
    figures.occupancy =
        occupancyOf([&](const Eigen::Vector3d* points_map, std::size_t n,
                        Answer* answers) { baseline.query(points_map, n, answers); },
                    testPoints);
    if (figures.ranked && !unseen.free_map.empty())
        figures.unseen = evaluateUnseen(
            [&](const Points& points_map) {
                std::vector<Answer> answers(points_map.size());
                baseline.query(points_map.data(), points_map.size(), answers.data());
                std::vector<Occupancy> occupancies;
                for (const Answer& answer : answers)
                    occupancies.push_back(occupancyOfAnswer(answer));
                return occupancies;
            },
            unseen);
    // After the queries, for which some maps finish work first.
    figures.memory.live_bytes = baseline.liveBytes();
    figures.memory.serialized_bytes = baseline.serializedBytes();
    return figures;
}

}  // namespace hgmm::evaluation
