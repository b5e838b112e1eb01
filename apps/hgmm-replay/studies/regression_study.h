#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/evaluation/gp_regression.h"
#include "hgmm/mixture.h"
#include "options.h"

namespace replay {

constexpr std::size_t kRegressionSets = 25;      ///< thesis 4.4.4
constexpr std::size_t kRegressionSetSize = 500;  ///< samples per set, thesis 4.4.4
constexpr std::size_t kRegressionQueries = 400;  ///< the test set, evenly spaced

/// What one model says over the test set.
struct RegressionFigures {
    double variance = 0.0;  ///< mean of v(x), noise included
    double entropy = 0.0;   ///< mean of 0.5 log(2 pi e v(x)) [nat]
    double rmse = 0.0;      ///< of the mean against sin(3 x)
};

/// Both models after so many sets.
struct RegressionStep {
    std::size_t sets = 0;
    RegressionFigures mixture, gp;
};

/// The two models at one point of the test set.
struct RegressionQuery {
    double x = 0.0;
    hgmm::evaluation::Prediction mixture, gp;
};

/// One sequence of sets.
struct RegressionRun {
    std::uint64_t seed = 0;
    std::size_t overestimate = 0;                   ///< components of the reference mixture
    hgmm::Mixture<2> first, last;                   ///< after the first and the last set
    std::vector<RegressionStep> steps;              ///< rising
    std::vector<RegressionQuery> queries;           ///< after the last set
    hgmm::evaluation::GpHyperparameters gpOptions;  ///< after the last set

    /// Mean variance of the mixture over that of the noise, less one, after the last set.
    double varianceError() const;
    /// Entropy of the mixture less that of the GP, after the last set [nat].
    double entropyError() const;
    /// Issue 3: variance within 15 %, entropy within 0.1 nat.
    bool holds() const;
};

/// Of a Gaussian of this variance [nat].
double differentialEntropy(double variance);

/// Trains both models with one sequence; queries after each set, or after the last only.
RegressionRun regressionRun(std::uint64_t seed, bool queryEachSet);

/// The 1D regression study of thesis 4.4.4 and fig. 4.5, and its end for 19 further seeds.
/// Prints a table and writes metrics.json and report.html into the report folder, if there
/// is one. Needs no recording.
void regressionStudy(const Options& options);

}  // namespace replay
