#include "studies/regression_report.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hgmm/evaluation/plot.h"
#include "hgmm/evaluation/timing.h"
#include "report_page.h"
#include "studies/noisy_sine.h"

namespace replay {
namespace {

using hgmm::evaluation::Curve;
using hgmm::evaluation::Plot;
using hgmm::evaluation::Prediction;
using Json = nlohmann::ordered_json;

constexpr double kNoiseVariance = NoisySine::kNoiseStd * NoisySine::kNoiseStd;

Curve trueMean(const std::vector<RegressionQuery>& queries) {
    Curve curve{{}, "sin(3x)", false};
    for (const RegressionQuery& q : queries)
        curve.points.emplace_back(q.x, NoisySine::mean(q.x));
    return curve;
}

/// Mean and two standard deviations of one model.
Plot predictionPlot(const RegressionRun& run, const std::string& name,
                    Prediction RegressionQuery::*model) {
    Plot plot{
        name + " after " + std::to_string(kRegressionSets) + " sets (thesis fig. 4.5)",
        "x",
        "y",
        {{{}, "mean", true}, trueMean(run.queries), {{}, "mean +- 2 sigma", false}}};
    std::vector<std::pair<double, double>> lower;
    for (const RegressionQuery& q : run.queries) {
        const Prediction& p = q.*model;
        const double width = 2 * std::sqrt(p.variance);
        plot.curves[0].points.emplace_back(q.x, p.mean);
        plot.curves[2].points.emplace_back(q.x, p.mean + width);
        lower.emplace_back(q.x, p.mean - width);
    }
    auto& band = plot.curves[2].points;  // around the mean: there and back again
    band.insert(band.end(), lower.rbegin(), lower.rend());
    return plot;
}

/// One figure of both models against the number of sets.
Plot convergencePlot(const RegressionRun& run, const std::string& yLabel,
                     double RegressionFigures::*figure, double limit) {
    Plot plot{"Rate of convergence (thesis fig. 4.5)",
              "sets of " + std::to_string(kRegressionSetSize) + " samples",
              yLabel,
              {{{}, "mixture", true}, {{}, "GP", true}, {{}, "of the noise", false}}};
    for (const RegressionStep& step : run.steps) {
        const auto sets = static_cast<double>(step.sets);
        plot.curves[0].points.emplace_back(sets, step.mixture.*figure);
        plot.curves[1].points.emplace_back(sets, step.gp.*figure);
        plot.curves[2].points.emplace_back(sets, limit);
    }
    return plot;
}

/// The 2 sigma ellipse of each component.
Plot componentPlot(const hgmm::Mixture<2>& mixture, const RegressionRun& run,
                   const std::string& when) {
    constexpr int kCorners = 48;
    Plot plot{std::to_string(mixture.size()) + " components after the " + when +
                  " set (thesis fig. 4.5)",
              "x",
              "y",
              {trueMean(run.queries)}};
    for (std::size_t j = 0; j < mixture.size(); ++j) {
        const hgmm::Gaussian<2> g = mixture[j];
        const Eigen::Matrix2d root = Eigen::LLT<Eigen::Matrix2d>(g.covariance).matrixL();
        Curve& ellipse = plot.curves.emplace_back();
        for (int k = 0; k <= kCorners; ++k) {
            const double angle = 6.283185307179586477 * k / kCorners;
            const Eigen::Vector2d p =
                g.mean + 2 * root * Eigen::Vector2d(std::cos(angle), std::sin(angle));
            ellipse.points.emplace_back(p.x(), p.y());
        }
    }
    return plot;
}

Json figuresJson(const RegressionFigures& f) {
    return {{"variance", f.variance}, {"entropy_nat", f.entropy}, {"rmse", f.rmse}};
}

Json regressionJson(const std::vector<RegressionRun>& runs) {
    const RegressionRun& run = runs.front();
    Json json{{"study", "fig4.5"},
              {"sets", kRegressionSets},
              {"samples_per_set", kRegressionSetSize},
              {"queries", kRegressionQueries},
              {"noise_variance", kNoiseVariance},
              {"seed", run.seed},
              {"overestimate", run.overestimate},
              {"components", run.last.size()},
              {"variance_error", run.varianceError()},
              {"entropy_error_nat", run.entropyError()},
              {"gp",
               {{"signal_std", run.gpOptions.signalStd},
                {"length_scale", run.gpOptions.lengthScale},
                {"noise_std", run.gpOptions.noiseStd}}}};
    for (const RegressionStep& step : run.steps)
        json["steps"].push_back({{"sets", step.sets},
                                 {"mixture", figuresJson(step.mixture)},
                                 {"gp", figuresJson(step.gp)}});
    for (const RegressionRun& r : runs)
        json["seeds"].push_back({{"seed", r.seed},
                                 {"overestimate", r.overestimate},
                                 {"components", r.last.size()},
                                 {"variance_error", r.varianceError()},
                                 {"entropy_error_nat", r.entropyError()},
                                 {"holds", r.holds()}});
    return json;
}

/// "name  least / median / most" over the runs.
template <typename Figure>
std::string spread(const char* name, const std::vector<RegressionRun>& runs,
                   const char* pattern, Figure&& figure) {
    std::vector<double> values;
    for (const RegressionRun& run : runs) values.push_back(figure(run));
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    std::string text = name;
    for (const double v : {*least, hgmm::evaluation::median(values), *most}) {
        char number[32];
        std::snprintf(number, sizeof number, pattern, v);
        text += number;
    }
    return text + "\n";
}

}  // namespace

std::string regressionSummary(const std::vector<RegressionRun>& runs) {
    const RegressionRun& run = runs.front();
    char line[240];
    std::snprintf(line, sizeof line,
                  "study fig4.5, seed %llu: %zu components (thesis: 14), estimated from an "
                  "overestimate of %zu\n\n",
                  static_cast<unsigned long long>(run.seed), run.last.size(),
                  run.overestimate);
    std::string text = line;
    text +=
        "        variance               entropy [nat]        error of the mean\n"
        "sets    mixture     GP         mixture   GP         mixture   GP\n";
    for (const RegressionStep& s : run.steps) {
        if (s.sets > 5 && s.sets % 5 != 0) continue;
        std::snprintf(line, sizeof line,
                      "%4zu    %.6f    %.6f   %.4f   %.4f    %.4f    %.4f\n", s.sets,
                      s.mixture.variance, s.gp.variance, s.mixture.entropy, s.gp.entropy,
                      s.mixture.rmse, s.gp.rmse);
        text += line;
    }
    std::snprintf(line, sizeof line,
                  "noise   %.6f\nvariance %+.1f %%, entropy %+.3f nat from the GP\n\n",
                  kNoiseVariance, 100 * run.varianceError(), run.entropyError());
    text += line;
    const auto held = std::count_if(runs.begin(), runs.end(),
                                    [](const RegressionRun& r) { return r.holds(); });
    std::snprintf(line, sizeof line,
                  "%td of %zu seeds have a variance within 15 %% and an entropy within 0.1 "
                  "nat; least, median, most:\n",
                  held, runs.size());
    text += line;
    text += spread("  components", runs, "  %6.4g", [](const RegressionRun& r) {
        return static_cast<double>(r.last.size());
    });
    text += spread("  variance [%]", runs, "  %+6.1f",
                   [](const RegressionRun& r) { return 100 * r.varianceError(); });
    return text + spread("  entropy [nat]", runs, "  %+6.3f",
                         [](const RegressionRun& r) { return r.entropyError(); });
}

void writeRegressionReport(const std::vector<RegressionRun>& runs, const Options& options) {
    const RegressionRun& run = runs.front();
    Json metrics = regressionJson(runs);
    for (const Plot& plot :
         {predictionPlot(run, "Mixture", &RegressionQuery::mixture),
          predictionPlot(run, "Gaussian process", &RegressionQuery::gp),
          convergencePlot(run, "differential entropy [nat]", &RegressionFigures::entropy,
                          differentialEntropy(kNoiseVariance)),
          convergencePlot(run, "variance", &RegressionFigures::variance, kNoiseVariance),
          componentPlot(run.first, run, "first"), componentPlot(run.last, run, "last")})
        metrics["plots"].push_back(plotJson(plot));
    writeReportFiles(std::move(metrics), options);
}

}  // namespace replay
