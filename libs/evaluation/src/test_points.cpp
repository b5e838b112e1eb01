#include "hgmm/evaluation/test_points.h"

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {

void TestPoints::add(const Scan& scan, std::size_t scanIndex) {
    const auto draw = [&](std::size_t n, Draw use, Points& points_map) {
        appendPoints(scan, chooseIndices(scan.size(), n, seed_, scanIndex, use),
                     points_map);
    };
    draw(kQueriesPerScan, Draw::queries, hits_map_);
    draw(kReferencePerScan, Draw::reference, reference_map_);
}

}  // namespace hgmm::evaluation
