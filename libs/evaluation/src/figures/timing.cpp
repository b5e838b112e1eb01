#include "hgmm/evaluation/timing.h"

#include <algorithm>
#include <cmath>

namespace hgmm::evaluation {

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const std::size_t half = values.size() / 2;
    std::nth_element(values.begin(), values.begin() + half, values.end());
    const double upper = values[half];
    if (values.size() % 2 == 1) return upper;
    return 0.5 * (upper + *std::max_element(values.begin(), values.begin() + half));
}

Timing summariseTimes(const std::vector<double>& durations_ms) {
    Timing timing;
    if (durations_ms.empty()) return timing;
    const std::size_t n = durations_ms.size();
    std::vector<double> sorted = durations_ms;
    std::sort(sorted.begin(), sorted.end());
    timing.median = median(durations_ms);
    const auto rank = static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(n)));
    timing.p99 = sorted[rank - 1];
    timing.worst = sorted.back();
    const auto tenth = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, n / 10));
    timing.firstTenth = median({durations_ms.begin(), durations_ms.begin() + tenth});
    timing.lastTenth = median({durations_ms.end() - tenth, durations_ms.end()});
    return timing;
}

}  // namespace hgmm::evaluation
