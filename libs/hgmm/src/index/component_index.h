#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "hgmm/gaussian.h"
#include "hgmm/mixture.h"
#include "hgmm/occupancy.h"
#include "index/box_index.h"

namespace hgmm {

/// Finds the components near a point at a cost that does not depend on the size of the map,
/// and keeps them factored for evaluation: a BoxIndex over the bounding boxes of their
/// `sigmas` ellipsoids.
class ComponentIndex {
 public:
    using Factor = WhitenedGaussian<3, float>;

    /// @param sigmas size of the indexed ellipsoids [sigma], > 0
    /// @param inflationStd_m isotropic standard deviation added to every component [m], >=
    /// 0
    explicit ComponentIndex(float sigmas = kSigmas, float inflationStd_m = 0.F)
        : sigmas_(sigmas), inflationVariance_(inflationStd_m * inflationStd_m) {}

    static constexpr float kSigmas = static_cast<float>(kReachSigmas);

    /// Enters every component of a mixture; data is copied.
    void rebuild(const Mixture<3>& mixture);
    /// Enters or re-enters component i, which must be < size() or the next one.
    void update(const Mixture<3>& mixture, std::uint32_t i);
    /// Drops components n, n + 1, ...
    void truncate(std::size_t n);
    void clear();
    /// Makes room for n components in all.
    void reserve(std::size_t n);

    std::size_t size() const { return factors_.size(); }
    const Factor& factor(std::uint32_t i) const { return factors_[i]; }

    /// Calls visit(i) for each component whose ellipsoid's box may hold (x, y, z), each
    /// once, in a fixed order.
    template <typename Visitor>
    void visitCandidates(float x, float y, float z, Visitor&& visit) const {
        boxes_.visitCandidates(x, y, z, visit);
    }

    /// The same for points in the order of cells: see BoxIndex.
    template <typename Visitor>
    void visitCandidates(const CellOrder& points, std::size_t begin, std::size_t end,
                         Visitor&& visit) const {
        boxes_.visitCandidates(points, begin, end, visit);
    }
    int smallestOctave() const { return boxes_.smallestOctave(); }

    /// Calls visit(i) for each component whose ellipsoid's box the ray from `start` along
    /// the unit vector `direction` may meet within `length` [m], possibly several times.
    template <typename Visitor>
    void visitAlongRay(const float* start, const float* direction, float length,
                       Visitor&& visit) const {
        boxes_.visitAlongRay(start, direction, length, visit);
    }

    /// Whether visitCandidates may visit a component, once it is entered, at a point of a
    /// box.
    bool reaches(const Gaussian<3>& component, const Eigen::AlignedBox3f& box) const;

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    BoxCells::Box boxOf(const Gaussian<3>& inflated) const;
    /// Of the component's box.
    std::array<float, 3> centreOf(std::uint32_t i) const {
        return {factors_[i].mean(0), factors_[i].mean(1), factors_[i].mean(2)};
    }

    float sigmas_;
    float inflationVariance_;
    std::vector<Factor> factors_;
    BoxIndex<3> boxes_;
};

}  // namespace hgmm
