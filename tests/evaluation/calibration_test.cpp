#include "hgmm/evaluation/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

using namespace hgmm::evaluation;

TEST(BrierScore, ByHand) {
    EXPECT_DOUBLE_EQ(brierScore({{0.8, true}, {0.3, false}, {0.5, true}}),
                     (0.04 + 0.09 + 0.25) / 3);
    EXPECT_EQ(brierScore({{1.0, true}, {0.0, false}}), 0.0);
    EXPECT_EQ(brierScore({{0.0, true}, {1.0, false}}), 1.0);
}

TEST(LogLoss, ByHandAndClamped) {
    EXPECT_DOUBLE_EQ(logLoss({{0.8, true}, {0.3, false}}),
                     -(std::log(0.8) + std::log(0.7)) / 2);
    EXPECT_NEAR(logLoss({{0.0, true}}), 13.815510557964274, 1e-9);
    EXPECT_NEAR(logLoss({{1.0, false}}), 13.815510557964274, 1e-9);
    EXPECT_NEAR(logLoss({{1.0, true}}), 0.0, 1.1e-6);
}

TEST(Reliability, BinsOfEqualMassByHand) {
    // Two bins of three.
    const auto diagram = reliabilityDiagram(
        {{0.9, true}, {0.1, false}, {0.7, false}, {0.2, true}, {0.8, true}, {0.3, false}},
        2);
    ASSERT_EQ(diagram.size(), 2U);
    EXPECT_NEAR(diagram[0].meanProbability, 0.2, 1e-12);
    EXPECT_NEAR(diagram[0].occupiedShare, 1.0 / 3, 1e-12);
    EXPECT_NEAR(diagram[1].meanProbability, 0.8, 1e-12);
    EXPECT_NEAR(diagram[1].occupiedShare, 2.0 / 3, 1e-12);
    EXPECT_NEAR(expectedCalibrationError(diagram), (1.0 / 3 - 0.2 + 0.8 - 2.0 / 3) / 2,
                1e-12);
}

TEST(Reliability, AForecastAcrossABorderIsParted) {
    // Two bins of one and a half.
    const auto diagram = reliabilityDiagram({{0.0, false}, {0.5, true}, {1.0, true}}, 2);
    EXPECT_NEAR(diagram[0].meanProbability, 0.25 / 1.5, 1e-12);
    EXPECT_NEAR(diagram[0].occupiedShare, 0.5 / 1.5, 1e-12);
    EXPECT_NEAR(diagram[1].meanProbability, 1.25 / 1.5, 1e-12);
    EXPECT_NEAR(diagram[1].occupiedShare, 1.0, 1e-12);
}

TEST(Reliability, TiedForecastsDoNotDependOnTheirOrder) {
    // All unknown, half of them occupied: calibrated, whatever comes first.
    std::vector<Forecast> forecasts(60, {0.5, true});
    forecasts.resize(120, {0.5, false});
    const double error = expectedCalibrationError(reliabilityDiagram(forecasts));
    EXPECT_NEAR(error, 0.0, 1e-12);
    std::reverse(forecasts.begin(), forecasts.end());
    EXPECT_EQ(expectedCalibrationError(reliabilityDiagram(forecasts)), error);
}

TEST(Reliability, OfCalibratedAndOverconfidentForecasts) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<Forecast> calibrated, overconfident;
    for (int i = 0; i < 150000; ++i) {
        const double p = uniform(engine);
        const bool occupied = uniform(engine) < p;
        calibrated.push_back({p, occupied});
        overconfident.push_back({p > 0.5 ? 1.0 : 0.0, occupied});
    }
    const auto diagram = reliabilityDiagram(calibrated);
    ASSERT_EQ(diagram.size(), 15U);
    EXPECT_LT(expectedCalibrationError(diagram), 0.01);
    // |p - round(p)| is 0.25 on average; in the middle one of 15 bins the errors cancel.
    EXPECT_NEAR(expectedCalibrationError(reliabilityDiagram(overconfident)), 0.25 * 14 / 15,
                0.005);
}

TEST(Calibration, RefusesNothingAndNonsense) {
    EXPECT_THROW(brierScore({}), std::invalid_argument);
    EXPECT_THROW(logLoss({}), std::invalid_argument);
    EXPECT_THROW(reliabilityDiagram({}), std::invalid_argument);
    EXPECT_THROW(reliabilityDiagram({{0.5, true}}, 0), std::invalid_argument);
    EXPECT_THROW(expectedCalibrationError({}), std::invalid_argument);
    for (const double p : {-0.1, 1.1, std::nan("")}) {
        EXPECT_THROW(brierScore({{p, true}}), std::invalid_argument) << p;
        EXPECT_THROW(logLoss({{p, true}}), std::invalid_argument) << p;
        EXPECT_THROW(reliabilityDiagram({{p, true}}), std::invalid_argument) << p;
    }
}
