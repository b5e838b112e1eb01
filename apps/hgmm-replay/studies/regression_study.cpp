#include "studies/regression_study.h"

#include <cmath>
#include <cstdio>

#include "hgmm/regression.h"
#include "studies/mixture_regression.h"
#include "studies/noisy_sine.h"
#include "studies/regression_report.h"

namespace replay {
namespace {

using hgmm::evaluation::GpHyperparameters;
using hgmm::evaluation::GpPosterior;
using hgmm::evaluation::GpRegression;
using hgmm::evaluation::Prediction;

constexpr std::size_t kSeeds = 20;

void addAll(GpRegression& gp, const hgmm::Mixture<2>& set) {
    for (std::size_t i = 0; i < set.size(); ++i) gp.add(set.mean[0][i], set.mean[1][i]);
}

std::vector<RegressionQuery> query(const hgmm::Mixture<2>& mixture, const GpPosterior& gp) {
    const hgmm::ConditionalMixture<2> prepared(mixture);
    hgmm::Conditional conditional;
    std::vector<RegressionQuery> queries(kRegressionQueries);
    const double step =
        (NoisySine::kHigh - NoisySine::kLow) / static_cast<double>(kRegressionQueries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        RegressionQuery& q = queries[i];
        q.x = NoisySine::kLow + (static_cast<double>(i) + 0.5) * step;
        prepared.at(&q.x, conditional);
        q.mixture = {conditional.mean(), conditional.variance()};
        q.gp = gp.predict(q.x);
    }
    return queries;
}

RegressionFigures figures(const std::vector<RegressionQuery>& queries,
                          Prediction RegressionQuery::*model) {
    RegressionFigures sum;
    for (const RegressionQuery& q : queries) {
        const Prediction& p = q.*model;
        const double error = p.mean - NoisySine::mean(q.x);
        sum.variance += p.variance;
        sum.entropy += differentialEntropy(p.variance);
        sum.rmse += error * error;
    }
    const auto n = static_cast<double>(queries.size());
    return {sum.variance / n, sum.entropy / n, std::sqrt(sum.rmse / n)};
}

}  // namespace

double RegressionRun::varianceError() const {
    return steps.back().mixture.variance / (NoisySine::kNoiseStd * NoisySine::kNoiseStd) -
           1.0;
}

double RegressionRun::entropyError() const {
    return steps.back().mixture.entropy - steps.back().gp.entropy;
}

bool RegressionRun::holds() const {
    return std::abs(varianceError()) <= 0.15 && std::abs(entropyError()) <= 0.1;
}

double differentialEntropy(double variance) {
    constexpr double kTwoPiE = 17.079468445347134131;
    return 0.5 * std::log(kTwoPiE * variance);
}

RegressionRun regressionRun(std::uint64_t seed, bool queryEachSet) {
    NoisySine sine(seed);
    hgmm::Mixture<2> set = sine.draw(kRegressionSetSize);
    MixtureRegression regression(set);
    GpRegression gp(NoisySine::kLow, NoisySine::kHigh);
    addAll(gp, set);

    RegressionRun run;
    run.seed = seed;
    run.overestimate = regression.overestimate();
    run.first = regression.mixture();
    for (std::size_t sets = 1;; ++sets) {
        if (queryEachSet || sets == kRegressionSets) {
            run.gpOptions = gp.maximiseLikelihood(run.gpOptions);
            run.queries = query(regression.mixture(), gp.condition(run.gpOptions));
            run.steps.push_back({sets, figures(run.queries, &RegressionQuery::mixture),
                                 figures(run.queries, &RegressionQuery::gp)});
        }
        if (sets == kRegressionSets) break;
        set = sine.draw(kRegressionSetSize);
        regression.update(set);
        addAll(gp, set);
    }
    run.last = regression.mixture();
    return run;
}

void regressionStudy(const Options& options) {
    std::vector<RegressionRun> runs(kSeeds);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t i = 0; i < kSeeds; ++i)
        runs[i] = regressionRun(options.split.seed + i, i == 0);
    std::fputs(regressionSummary(runs).c_str(), stdout);
    if (options.reportFolder) writeRegressionReport(runs, options);
}

}  // namespace replay
