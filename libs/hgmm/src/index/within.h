#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/simd.h"
#include "hgmm/em.h"
#include "index/component_index.h"

namespace hgmm {

/// A point and a component within whose ellipsoid it lies.
struct Match {
    std::uint32_t point, component;
};

/// Which of four points, from k on, lie within the root of `maxSquared` of a component
/// [sigma], by the sums that Factor::isWithin makes: bits 0 to 3.
inline unsigned areWithin(const ComponentIndex::Factor& factor, const CellOrder& points,
                          std::size_t k, float maxSquared) {
    Float4 x, y, z;
    std::memcpy(&x, points.x.data() + k, sizeof(x));
    std::memcpy(&y, points.y.data() + k, sizeof(y));
    std::memcpy(&z, points.z.data() + k, sizeof(z));
    x -= factor.mean(0), y -= factor.mean(1), z -= factor.mean(2);
    const Float4 a = factor.factor(0, 0) * x;
    const Float4 b = factor.factor(1, 0) * x + factor.factor(1, 1) * y;
    const Float4 c =
        factor.factor(2, 0) * x + factor.factor(2, 1) * y + factor.factor(2, 2) * z;
    return bitsOf(a * a + b * b + c * c <= maxSquared);
}

/// Calls visit(k, j) for each of the points `begin` to `end` - 1 and each component within
/// the root of `maxSquared` of which it lies [sigma].
template <typename Visitor>
void visitWithin(const ComponentIndex& index, const CellOrder& points, std::size_t begin,
                 std::size_t end, float maxSquared, Visitor&& visit) {
    index.visitCandidates(
        points, begin, end, [&](std::uint32_t j, std::size_t first, std::size_t last) {
            const ComponentIndex::Factor& factor = index.factor(j);
            for (std::size_t k = first; k < last; k += 4) {
                unsigned within = areWithin(factor, points, k, maxSquared);
                if (last - k < 4) within &= (1U << (last - k)) - 1U;
                for (; within != 0; within &= within - 1)
                    visit(k + static_cast<unsigned>(__builtin_ctz(within)), j);
            }
        });
}

/// The components of each point, rising.
/// @param matches in no order
/// @param points how many there are
Neighbourhoods neighbourhoodsOf(const std::vector<Match>& matches, std::size_t points);

}  // namespace hgmm
