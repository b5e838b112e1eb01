#pragma once
#include <cstddef>
#include <vector>

namespace hgmm::evaluation {

/// A probability of being occupied, and what was there.
struct Forecast {
    double probability = 0.5;  ///< [0, 1]
    bool occupied = false;
};

/// Forecasts are only clamped for the logarithm, to this distance from 0 and 1: one that is
/// wrong beyond all doubt costs 13.8 nat.
constexpr double kLogLossClamp = 1e-6;

/// Mean squared error of the probabilities, [0, 1]; 0.25 for 0.5 everywhere. Like the
/// others here it throws std::invalid_argument if there are no forecasts, or one is outside
/// [0, 1].
double brierScore(const std::vector<Forecast>& forecasts);

/// Mean negative log-probability of what was there [nat], >= 0.
double logLoss(const std::vector<Forecast>& forecasts);

/// Forecasts of similar probability.
struct ReliabilityBin {
    double meanProbability = 0.0;  ///< as forecast
    double occupiedShare = 0.0;    ///< as it was
};

constexpr std::size_t kReliabilityBins = 15;

/// Bins of equal mass, probabilities rising: each holds the same number of forecasts, of
/// which one need not be whole. Equal forecasts that lie across a border are parted in
/// proportion, so that their order does not matter. Calibrated forecasts have equal members
/// in each bin.
std::vector<ReliabilityBin> reliabilityDiagram(const std::vector<Forecast>& forecasts,
                                               std::size_t bins = kReliabilityBins);

/// Expected calibration error, [0, 1]: mean distance of the members of bins of equal mass.
/// Throws std::invalid_argument if there are no bins.
double expectedCalibrationError(const std::vector<ReliabilityBin>& diagram);

}  // namespace hgmm::evaluation
