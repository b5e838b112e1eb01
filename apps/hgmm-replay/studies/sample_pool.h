#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "hgmm/mixture.h"

namespace replay {

/// The samples of many scans, those in the same leaf of a grid merged, so that memory is
/// bounded and every moment is kept.
class SamplePool {
 public:
    /// @param edge_m edge of a leaf [m], > 0
    /// @param capacity leaves held at most: the edge doubles where there would be more
    /// [count],
    /// >= 1
    SamplePool(double edge_m, std::size_t capacity)
        : edge_m_(edge_m), capacity_(capacity) {}

    void add(const hgmm::Mixture<3>& samples);

    /// One sample per leaf, in the order of their first samples.
    hgmm::Mixture<3> samples() const;
    std::size_t size() const { return leaves_.size(); }
    /// Edge of a leaf [m].
    double edge_m() const { return edge_m_; }

    /// The same samples in leaves of twice the edge.
    SamplePool coarser() const;

 private:
    using Cell = std::array<std::int64_t, 3>;
    struct CellHash {
        std::size_t operator()(const Cell& cell) const;
    };

    void add(const hgmm::Gaussian<3>& sample);

    double edge_m_;
    std::size_t capacity_;
    std::unordered_map<Cell, std::size_t, CellHash> leafOf_;
    std::vector<hgmm::Gaussian<3>> leaves_;
};

}  // namespace replay
