#include "hgmm/evaluation/occupancy_figures.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

std::vector<double> probabilities(const std::vector<Answer>& answers) {
    std::vector<double> result;
    result.reserve(answers.size());
    for (const Answer& a : answers) result.push_back(a.probability);
    return result;
}

double unknownShare(const std::vector<Answer>& answers) {
    const auto unknown = std::count_if(answers.begin(), answers.end(),
                                       [](const Answer& a) { return a.unknown; });
    return static_cast<double>(unknown) / static_cast<double>(answers.size());
}

/// Hits and near free points, one of each for every ray that has both.
std::vector<Forecast> pairedForecasts(const std::vector<Answer>& hits,
                                      const std::vector<Answer>& nearFree,
                                      const std::vector<std::size_t>& hitOfNear) {
    std::vector<Forecast> forecasts;
    forecasts.reserve(2 * nearFree.size());
    for (std::size_t i = 0; i < nearFree.size(); ++i) {
        forecasts.push_back({hits[hitOfNear[i]].probability, true});
        forecasts.push_back({nearFree[i].probability, false});
    }
    return forecasts;
}

}  // namespace

BatchQuery queryOf(const Map& map, std::size_t level) {
    return
        [&map, level](const Eigen::Vector3d* points_map, std::size_t n, Answer* answers) {
            std::vector<Occupancy> occupancy(n);
            map.occupancy(points_map, n, occupancy.data(), level);
            for (std::size_t i = 0; i < n; ++i)
                answers[i] = {occupancy[i].probability(), occupancy[i].unknown > 0.5F};
        };
}

std::vector<Answer> answersOf(const BatchQuery& query, const Points& points_map) {
    std::vector<Answer> answers(points_map.size());
    for (std::size_t i = 0; i < points_map.size(); i += kQueryBatch)
        query(&points_map[i], std::min(kQueryBatch, points_map.size() - i), &answers[i]);
    return answers;
}

OccupancyFigures evaluateOccupancy(const BatchQuery& query, const TestPoints& testPoints) {
    const FreePoints &uniform = testPoints.uniformFree(), &near = testPoints.nearFree();
    if (testPoints.empty() || uniform.points_map.empty() || near.points_map.empty())
        throw std::invalid_argument(
            "occupancy cannot be evaluated: there are no test points, or all rays are too "
            "short for free points");
    // A first query may have to build what later ones use.
    answersOf(query, {testPoints.hits().front()});

    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    const std::vector<Answer> hitAnswers = answersOf(query, testPoints.hits());
    const std::vector<Answer> uniformAnswers = answersOf(query, uniform.points_map);
    const std::vector<Answer> nearAnswers = answersOf(query, near.points_map);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();

    OccupancyFigures f;
    f.hits = hitAnswers.size();
    f.uniformFree = uniformAnswers.size();
    f.nearFree = nearAnswers.size();
    f.queriesPerSecond = static_cast<double>(f.hits + f.uniformFree + f.nearFree) / seconds;
    const std::vector<double> hits = probabilities(hitAnswers);
    const std::vector<double> nearFree = probabilities(nearAnswers);
    f.rocUniform = rocCurve(hits, probabilities(uniformAnswers));
    f.rocNear = rocCurve(hits, nearFree);
    f.aucUniform = areaUnder(f.rocUniform);
    f.aucNear = areaUnder(f.rocNear);
    f.balancedAccuracyNear = balancedAccuracy(hits, nearFree);

    const auto forecasts = pairedForecasts(hitAnswers, nearAnswers, near.hits);
    f.brier = brierScore(forecasts);
    f.logLoss = logLoss(forecasts);
    f.reliability = reliabilityDiagram(forecasts);
    f.ece = expectedCalibrationError(f.reliability);

    f.unknownShareHit = unknownShare(hitAnswers);
    f.unknownShareFree = unknownShare(uniformAnswers);
    f.unknownShareNear = unknownShare(nearAnswers);
    return f;
}

}  // namespace hgmm::evaluation
