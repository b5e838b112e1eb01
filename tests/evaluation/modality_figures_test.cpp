#include "hgmm/evaluation/modality_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace hgmm::evaluation {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Scan fivePoints() {
    Scan scan;
    for (int i = 0; i < 5; ++i) scan.pushBack(float(i), 1, 2);
    scan.channels = {{"r", {0, .1F, .2F, .3F, .4F}},
                     {"b", {.5F, kNan, .7F, .8F, .9F}},
                     {"intensity", {1, 1, 1, 1, 1}}};
    scan.T_map_sensor.t.x() = 100;
    return scan;
}

TEST(ModalityPoints, OnlyPointsWhereAllWereMeasured) {
    Scan scan = fivePoints();
    scan.x[3] = kNan;
    ModalityPoints points{{"b", "r"}, {}, {}};
    appendMeasured(scan, {0, 1, 3, 4}, points);
    ASSERT_EQ(points.size(), 2U) << "1 has no b, 3 no place";
    EXPECT_NEAR(points.points_map[1].x(), 104, 1e-9);
    EXPECT_FLOAT_EQ(points.values[0][1], .9F);
    EXPECT_FLOAT_EQ(points.values[1][1], .4F);
    scan.channels.erase(scan.channels.begin());
    appendMeasured(scan, {0, 4}, points);
    EXPECT_EQ(points.size(), 2U) << "a scan without r has nothing to say";
}

TEST(ModalityPoints, PoorChannelsKeepTheirShareAndOthersAll) {
    Scan scan;
    for (int i = 0; i < 1000; ++i) scan.pushBack(1, 2, 3);
    scan.channels = {{"r", std::vector<float>(1000, .5F)},
                     {"b", std::vector<float>(1000, .5F)}};
    Scan again = scan;
    keepShare(scan, "b", 0.1, 7, 3);
    const auto measured = [](const Channel& channel) {
        return std::count_if(channel.values.begin(), channel.values.end(),
                             [](float v) { return std::isfinite(v); });
    };
    EXPECT_EQ(measured(scan.channels[0]), 1000);
    EXPECT_EQ(measured(scan.channels[1]), 100);
    EXPECT_NO_THROW(scan.validate());
    keepShare(again, "b", 0.1, 7, 3);
    const Channel first = again.channels[1];
    keepShare(again, "b", 0.1, 8, 3);
    EXPECT_LT(measured(again.channels[1]), 40) << "another seed, other points";
    for (std::size_t i = 0; i < 1000; ++i)
        EXPECT_EQ(std::isfinite(first.values[i]),
                  std::isfinite(scan.channels[1].values[i]));
}

ModalityEstimate estimate(double mean, double variance = 1, bool known = true) {
    return {mean, variance, known};
}

// By hand: truth 1, 2, 3, 6 has mean 3 and squares 4 + 1 + 0 + 9 = 14 about it.
TEST(ModalityScore, R2IsTheShareExplained) {
    const std::vector<double> truth{1, 2, 3, 6};
    const auto score = [&](std::vector<double> means) {
        std::vector<ModalityEstimate> estimates;
        for (const double m : means) estimates.push_back(estimate(m));
        return scoreOf(estimates, truth);
    };
    EXPECT_DOUBLE_EQ(score({1, 2, 3, 6}).r2, 1);
    EXPECT_DOUBLE_EQ(score({3, 3, 3, 3}).r2, 0);
    EXPECT_DOUBLE_EQ(score({1, 2, 3, 4}).r2, 1 - 4.0 / 14);
    EXPECT_DOUBLE_EQ(score({1, 2, 3, 4}).mse, 1);
    EXPECT_LT(score({6, 3, 2, 1}).r2, 0) << "worse than the mean";
}

TEST(ModalityScore, UnknownPointsCount) {
    const ModalityScore score = scoreOf(
        {estimate(1), estimate(3, 1, false), estimate(3), estimate(6)}, {1, 2, 3, 6});
    EXPECT_DOUBLE_EQ(score.r2, 1 - 1.0 / 14);
    EXPECT_DOUBLE_EQ(score.knownShare, 0.75);
    EXPECT_EQ(score.points, 4U);
}

TEST(ModalityScore, TenthsFollowThePredictedVariance) {
    // Errors have the predicted variance: v in (0, 1], so its tenths' means are .05 and
    // .95.
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::vector<ModalityEstimate> estimates;
    std::vector<double> truth;
    for (int i = 0; i < 100000; ++i) {
        const double variance = (i % 1000 + 1) / 1000.0;
        estimates.push_back(estimate(0.5, variance));
        truth.push_back(0.5 + std::sqrt(variance) * normal(random));
    }
    const ModalityScore score = scoreOf(estimates, truth);
    EXPECT_NEAR(score.mseOfSurest, 0.05, 0.005);
    EXPECT_NEAR(score.mseOfLeastSure, 0.95, 0.05);
    EXPECT_NEAR(score.mse, 0.5, 0.02);
}

TEST(ModalityScore, DegenerateInput) {
    EXPECT_EQ(scoreOf({}, {}).r2, 0);
    EXPECT_EQ(scoreOf({estimate(2)}, {2}).r2, 1);
    EXPECT_EQ(scoreOf({estimate(3), estimate(2)}, {2, 2}).r2, 0);
    EXPECT_THROW(scoreOf({estimate(2)}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm::evaluation
