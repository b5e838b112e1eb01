#include "index/within.h"

#include <algorithm>

namespace hgmm {

Neighbourhoods neighbourhoodsOf(const std::vector<Match>& matches, std::size_t points) {
    Neighbourhoods all;
    all.begin.assign(points + 1, 0);
    for (const Match& m : matches) ++all.begin[m.point + 1];
    for (std::size_t i = 0; i < points; ++i) all.begin[i + 1] += all.begin[i];
    all.component.resize(all.begin[points]);
    std::vector<std::uint32_t> next(all.begin.begin(), all.begin.end() - 1);
    for (const Match& m : matches) all.component[next[m.point]++] = m.component;
    for (std::size_t i = 0; i < points; ++i)
        std::sort(all.component.begin() + all.begin[i],
                  all.component.begin() + all.begin[i + 1]);
    return all;
}

}  // namespace hgmm
