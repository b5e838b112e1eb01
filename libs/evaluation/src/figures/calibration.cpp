#include "hgmm/evaluation/calibration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

void requireForecasts(const std::vector<Forecast>& forecasts) {
    if (forecasts.empty()) throw std::invalid_argument("forecasts: there are none");
    for (const Forecast& f : forecasts)
        if (!(f.probability >= 0.0 && f.probability <= 1.0))
            throw std::invalid_argument("forecasts: one is not within [0, 1]");
}

/// Forecasts of one probability.
struct Tied {
    double probability;
    double count, occupied;
};

std::vector<Tied> groupTied(std::vector<Forecast> forecasts) {
    std::sort(forecasts.begin(), forecasts.end(), [](const Forecast& a, const Forecast& b) {
        return a.probability < b.probability;
    });
    std::vector<Tied> groups;
    for (const Forecast& f : forecasts) {
        if (groups.empty() || groups.back().probability != f.probability)
            groups.push_back({f.probability, 0.0, 0.0});
        groups.back().count += 1.0;
        groups.back().occupied += f.occupied ? 1.0 : 0.0;
    }
    return groups;
}

}  // namespace

double brierScore(const std::vector<Forecast>& forecasts) {
    requireForecasts(forecasts);
    double sum = 0.0;
    for (const Forecast& f : forecasts) {
        const double error = f.probability - (f.occupied ? 1.0 : 0.0);
        sum += error * error;
    }
    return sum / static_cast<double>(forecasts.size());
}

double logLoss(const std::vector<Forecast>& forecasts) {
    requireForecasts(forecasts);
    double sum = 0.0;
    for (const Forecast& f : forecasts) {
        const double p = f.occupied ? f.probability : 1.0 - f.probability;
        sum -= std::log(std::clamp(p, kLogLossClamp, 1.0 - kLogLossClamp));
    }
    return sum / static_cast<double>(forecasts.size());
}

std::vector<ReliabilityBin> reliabilityDiagram(const std::vector<Forecast>& forecasts,
                                               std::size_t bins) {
    requireForecasts(forecasts);
    if (bins == 0) throw std::invalid_argument("reliabilityDiagram: no bins");
    const std::vector<Tied> groups = groupTied(forecasts);
    const double mass = static_cast<double>(forecasts.size()) / static_cast<double>(bins);
    std::vector<ReliabilityBin> diagram(bins);
    std::size_t group = 0;
    double used = 0.0;  // of groups[group]
    for (ReliabilityBin& bin : diagram) {
        for (double missing = mass; missing > 0.0 && group < groups.size();) {
            const Tied& tied = groups[group];
            const double taken = std::min(missing, tied.count - used);
            bin.meanProbability += taken / mass * tied.probability;
            bin.occupiedShare += taken / mass * tied.occupied / tied.count;
            missing -= taken;
            used += taken;
            if (used >= tied.count) ++group, used = 0.0;
        }
    }
    return diagram;
}

double expectedCalibrationError(const std::vector<ReliabilityBin>& diagram) {
    if (diagram.empty()) throw std::invalid_argument("expectedCalibrationError: no bins");
    double sum = 0.0;
    for (const ReliabilityBin& bin : diagram)
        sum += std::abs(bin.meanProbability - bin.occupiedShare);
    return sum / static_cast<double>(diagram.size());
}

}  // namespace hgmm::evaluation
