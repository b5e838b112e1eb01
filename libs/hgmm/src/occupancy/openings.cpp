#include "occupancy/openings.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hgmm {

namespace {

/// A ray is aside by so much: at 1 m, growing with the root of the range [m], and of the
/// range [1].
constexpr double kAsideAtOneMetre_m = 0.01, kAsidePerMetre = 0.005;

std::vector<int> united(std::vector<int> a, const std::vector<int>& b) {
    a.insert(a.end(), b.begin(), b.end());
    std::sort(a.begin(), a.end());
    a.erase(std::unique(a.begin(), a.end()), a.end());
    return a;
}

}  // namespace

Openings::Openings(Coverage cells, Coverage once)
    : cells_(std::move(cells)), once_(std::move(once)) {
    cells_.forEachBlock(
        [this](const LatticeCell& block, Coverage::Word open) { once_.mark(block, open); });
}

void Openings::learn(const Coverage& passed, const Mixture<3>& hits,
                     const Eigen::Vector3d& sensorOrigin, const Coverage::Rays& rays) {
    if (passed.empty() && empty()) return;
    const std::vector<int> octaves = united(passed.octaves(), once_.octaves());
    Coverage onlyPassed = passed;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Eigen::Vector3d hit = hits.meanAt(i);
        const double range_m = (hit - sensorOrigin).norm();
        const Eigen::Vector3d around = Eigen::Vector3d::Constant(
            std::max(powerOfTwo(octaveAt(range_m, rays)) / 2,
                     kAsideAtOneMetre_m * std::sqrt(range_m) + kAsidePerMetre * range_m));
        for (const int octave : octaves) {
            const CellRange near(LatticeCell::at(hit - around, octave),
                                 LatticeCell::at(hit + around, octave));
            const auto isKnown = [&](const LatticeCell& group) {
                return !passed.group(group).empty() || !once_.group(group).empty();
            };
            near.forEachBlock(isKnown, [&](const LatticeCell& block) {
                const Coverage::Word now = passed.word(block);
                if ((now | once_.word(block)) == 0) return;
                const Coverage::Word cells = near.cellsIn(block);
                onlyPassed.unmark(block, cells);
                // An open cell that holds an edge stays open.
                once_.unmark(block, cells & ~(now & cells_.word(block)));
                cells_.unmark(block, cells & ~now);
            });
        }
    }
    onlyPassed.forEachBlock([&](const LatticeCell& block, Coverage::Word cells) {
        cells_.mark(block, cells & once_.word(block));
        once_.mark(block, cells);
    });
}

}  // namespace hgmm
