#pragma once
#include <cstddef>
#include <cstdint>

#include "hgmm/evaluation/free_points.h"
#include "hgmm/evaluation/points.h"
#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {

/// Points that the map never saw, drawn scan by scan (protocol, step 2). Every scan counts
/// the same, however many points it has, unless it has fewer than are drawn.
class TestPoints {
 public:
    static constexpr std::size_t kQueriesPerScan = 2000;     ///< hits
    static constexpr std::size_t kReferencePerScan = 20000;  ///< for reconstruction

    explicit TestPoints(std::uint64_t seed, const NearBand& near = {},
                        const FreeBand& free = {})
        : seed_(seed), nearBand_(near), freeBand_(free) {}

    /// Draws from a test scan, or from the held-out points of a mapping scan.
    void add(const Scan& scan, std::size_t scanIndex);

    bool empty() const { return hits_map_.empty(); }
    /// Measured points [m], map frame.
    const Points& hits() const { return hits_map_; }
    /// One point of each hit's ray within the free band; hits whose rays are too short for
    /// one have none.
    const FreePoints& uniformFree() const { return uniformFree_; }
    /// The same within the near band: the hard negatives.
    const FreePoints& nearFree() const { return nearFree_; }
    /// A denser sample of the measured surfaces [m], map frame.
    const Points& reference() const { return reference_map_; }

    const NearBand& nearBand() const { return nearBand_; }
    const FreeBand& freeBand() const { return freeBand_; }

 private:
    template <class Band>
    void drawFree(const Scan& scan, const std::vector<std::size_t>& hits,
                  std::size_t scanIndex, Draw use, const Band& band, FreePoints& free);

    std::uint64_t seed_;
    NearBand nearBand_;
    FreeBand freeBand_;
    Points hits_map_;
    FreePoints uniformFree_, nearFree_;
    Points reference_map_;
};

}  // namespace hgmm::evaluation
