#include <algorithm>
#include <limits>
#include <stdexcept>

#include "hgmm/em.h"
#include "index/component_index.h"

namespace hgmm {

namespace {

std::uint32_t likeliest(const ComponentIndex& index, const float* point) {
    std::uint32_t best = 0;
    float bestLogPdf = -std::numeric_limits<float>::infinity();
    for (std::uint32_t j = 0; j < index.size(); ++j) {
        const float logPdf = index.factor(j).logPdf(point);
        if (logPdf > bestLogPdf) bestLogPdf = logPdf, best = j;
    }
    return best;
}

}  // namespace

Neighbourhoods neighbourhoodsOf(const std::array<std::vector<float>, 3>& points,
                                const Mixture<3>& mixture, double sigmas) {
    if (mixture.empty()) throw std::invalid_argument("no neighbours in an empty mixture");
    ComponentIndex index(static_cast<float>(sigmas));
    index.rebuild(mixture);
    const auto maxSquared = static_cast<float>(sigmas * sigmas);
    Neighbourhoods result;
    result.begin.push_back(0);
    for (std::size_t i = 0; i < points[0].size(); ++i) {
        const float p[3] = {points[0][i], points[1][i], points[2][i]};
        const auto first = static_cast<std::ptrdiff_t>(result.component.size());
        index.visitCandidates(p[0], p[1], p[2], [&](std::uint32_t j) {
            if (index.factor(j).isWithin(p, maxSquared)) result.component.push_back(j);
        });
        if (result.component.size() == result.begin.back())
            result.component.push_back(likeliest(index, p));
        std::sort(result.component.begin() + first, result.component.end());
        result.begin.push_back(static_cast<std::uint32_t>(result.component.size()));
    }
    return result;
}

}  // namespace hgmm
