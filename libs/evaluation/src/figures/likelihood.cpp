#include "hgmm/evaluation/likelihood.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/gaussian.h"

namespace hgmm::evaluation {

double heldOutLogLikelihood(const std::function<double(const Eigen::Vector3d&)>& logDensity,
                            const Points& hits_map) {
    Box box = boundingBox(hits_map);
    box.low.array() -= kFloorMargin_m;
    box.high.array() += kFloorMargin_m;
    const double logFloor = std::log(kOutlierRatio / box.volume());
    const double logInlier = std::log1p(-kOutlierRatio);

    std::vector<double> logLikelihood(hits_map.size());
    const auto n = static_cast<std::ptrdiff_t>(hits_map.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t i = 0; i < n; ++i)
        logLikelihood[i] = logAddExp(logFloor, logInlier + logDensity(hits_map[i]));

    // Summed in order, so that the figure does not depend on the number of threads.
    double sum = 0.0;
    for (const double v : logLikelihood) sum += v;
    if (!std::isfinite(sum))
        throw std::runtime_error("heldOutLogLikelihood: a log-density is NaN or +infinity");
    return sum / static_cast<double>(hits_map.size());
}

}  // namespace hgmm::evaluation
