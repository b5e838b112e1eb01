#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/scan.h"
#include "index/component_index.h"
#include "registration/registration_cost.h"

namespace hgmm {

/// The target components next to a source component, nearest first; kNobody where there are
/// fewer.
struct Neighbours {
    static constexpr int kMost = 2;
    static constexpr std::uint32_t kNobody = 0xFFFFFFFFU;

    bool none() const { return target[0] == kNobody; }

    std::uint32_t layer = 0;
    std::array<std::uint32_t, kMost> target{kNobody, kNobody};
};

/// Square root of the moments of inertia of points with these second moments [m^2] about
/// their centre: a small rotation w moves them by |gyrationRadii w|, rms [m].
Eigen::Matrix3d gyrationRadiiOf(const Eigen::Matrix3d& moments);

/// The source's components about their centre.
struct RegistrationSource {
    explicit RegistrationSource(const Mixture<3>& mixture);

    std::size_t size() const { return mean.size(); }
    /// Share of the support that has a neighbour, in [0, 1]; 0 for an empty source.
    double shareOf(const std::vector<Neighbours>& neighbours) const;
    /// The first component of each cell of a grid, about the same centre.
    RegistrationSource thinned(double cell_m) const;

    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the means [m]
    double gyrationRadius_m = 0.0;                     ///< their rms distance from it, > 0
    /// Positive definite [m]: a small rotation w about the centre, in the source's axes,
    /// moves the components' points by |gyrationRadii w|, rms.
    Eigen::Matrix3d gyrationRadii = Eigen::Matrix3d::Identity();
    std::vector<Eigen::Vector3d> mean;  ///< less the centre
    std::vector<Eigen::Matrix3d> covariance;
    std::vector<double> support;  ///< [count]

 private:
    RegistrationSource() = default;
};

/// Principal axes of a mixture's finite components.
struct Shapes {
    explicit Shapes(const Mixture<3>& mixture);

    std::vector<Gaussian<3>> components;
    std::vector<Eigen::Matrix3d> axes;       ///< columns
    std::vector<Eigen::Vector3d> variances;  ///< rising [m^2]
};

/// How far off the pose may still be: what a source component at distance r from the
/// centre may be off by is hypot(width_m, angle_rad r).
struct SearchRadius {
    double width_m = 0.0;
    double angle_rad = 0.0;

    double at(double distance_m) const {
        return std::hypot(width_m, angle_rad * distance_m);
    }
};

/// The target at one width.
struct TargetLayer {
    TargetLayer(const Shapes& target, double width);

    double width_m;
    ComponentIndex index;
    std::vector<Eigen::Vector3d> mean;
    std::vector<Eigen::Matrix3d> widened;
};

/// The target at widths that rise in octaves, and the sums of the cost. Sums are over
/// chunks of fixed size, added in order.
class TargetLayers {
 public:
    /// Narrow to wide: the first has the width of the finest stage.
    void push(const Shapes& target, double width_m) {
        layers_.emplace_back(target, width_m);
    }

    /// @param T_target_centre from the source's centred frame
    std::vector<Neighbours> associate(const RegistrationSource& source,
                                      const SearchRadius& searchRadius,
                                      const Pose& T_target_centre) const;

    double cost(const RegistrationSource& source, const std::vector<Neighbours>& neighbours,
                const Pose& T_target_centre) const;
    /// The cost of each source component, in [-Neighbours::kMost, 0].
    std::vector<double> costs(const RegistrationSource& source,
                              const std::vector<Neighbours>& neighbours,
                              const Pose& T_target_centre) const;
    CostSums sums(const RegistrationSource& source,
                  const std::vector<Neighbours>& neighbours,
                  const Pose& T_target_centre) const;
    /// Sum over all components, source and target, of the outer product of their gradient:
    /// how much the gradient would scatter if they were drawn anew.
    Matrix6d gradientScatter(const RegistrationSource& source,
                             const std::vector<Neighbours>& neighbours,
                             const Pose& T_target_centre) const;

 private:
    std::uint32_t layerOf(double width_m) const;
    template <typename Visitor>
    void forEachPair(const RegistrationSource& source,
                     const std::vector<Neighbours>& neighbours, const Pose& T_target_centre,
                     std::size_t first, std::size_t last, Visitor&& visit) const;
    /// Sums over all pairs, in chunks on all threads: add(pair, sum of its chunk).
    template <typename Sum, typename Add>
    Sum sumOverPairs(const RegistrationSource& source,
                     const std::vector<Neighbours>& neighbours, const Pose& T_target_centre,
                     Add&& add) const;

    std::vector<TargetLayer> layers_;
};

}  // namespace hgmm
