#pragma once
#include <cstddef>
#include <cstdint>

#include "hgmm/evaluation/points.h"

namespace hgmm::evaluation {

/// Points that the map never saw, drawn scan by scan (protocol, step 2). Every scan counts
/// the same, however many points it has, unless it has fewer than are drawn.
class TestPoints {
 public:
    static constexpr std::size_t kQueriesPerScan = 2000;     ///< for likelihoods
    static constexpr std::size_t kReferencePerScan = 20000;  ///< for reconstruction

    explicit TestPoints(std::uint64_t seed) : seed_(seed) {}

    /// Draws from a test scan, or from the held-out points of a mapping scan.
    void add(const Scan& scan, std::size_t scanIndex);

    bool empty() const { return hits_map_.empty(); }
    /// Measured points [m], map frame.
    const Points& hits() const { return hits_map_; }
    /// A denser sample of the measured surfaces [m], map frame.
    const Points& reference() const { return reference_map_; }

 private:
    std::uint64_t seed_;
    Points hits_map_;
    Points reference_map_;
};

}  // namespace hgmm::evaluation
