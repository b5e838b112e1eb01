#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"

namespace hgmm {

/// The rays of one scan by direction, in bins on the faces of a cube around the sensor.
class RayImage {
 public:
    struct Ray {
        Eigen::Vector3d direction;  ///< unit vector
        double length_m;            ///< > 0
    };

    /// @param ends where the rays of a scan end, in the frame of `origin`
    RayImage(const Mixture<3>& ends, const Eigen::Vector3d& origin);

    const Eigen::Vector3d& origin() const { return origin_; }
    /// The nearest measurement in the bin of a direction and the bins beside it [m]; 0
    /// where there is none in its own bin.
    float nearestRange(const Eigen::Vector3d& direction) const;

    /// Length of the longest ray [m]; 0 without any.
    double longest_m() const { return longest_m_; }

    /// Whether isWanted(ray) holds of one of the rays of all bins that reach within an
    /// angle, up to 0.6 rad, of a direction and hold a ray of at least `length_m`. They are
    /// asked in a fixed order, up to the first of which it holds.
    template <typename Predicate>
    bool anyAround(const Eigen::Vector3d& direction, double angle_rad, double length_m,
                   Predicate&& isWanted) const;
    /// Calls visit(ray) for all of them.
    template <typename Visitor>
    void visitAround(const Eigen::Vector3d& direction, double angle_rad, double length_m,
                     Visitor&& visit) const {
        anyAround(direction, angle_rad, length_m, [&](const Ray& ray) {
            visit(ray);
            return false;
        });
    }

    /// Calls visit(ray) for all rays.
    template <typename Visitor>
    void visitAll(Visitor&& visit) const {
        for (const Ray& ray : rays_) visit(ray);
    }

 private:
    static constexpr int kBins = 45;  // an axis of a face: 2 degrees
    static constexpr std::size_t kAllBins = std::size_t{6} * kBins * kBins;

    static std::size_t numberOf(int face, int row, int col) {
        return static_cast<std::size_t>((face * kBins + row) * kBins + col);
    }
    static int binAt(double v) {
        return std::clamp(static_cast<int>((v + 1) * (kBins / 2.0)), 0, kBins - 1);
    }
    struct Bin {
        int face, row, col;
    };
    static Bin binOf(const Eigen::Vector3d& direction);

    Eigen::Vector3d origin_;
    std::vector<Ray> rays_;             ///< by bin
    std::vector<std::uint32_t> first_;  ///< of each bin in rays_, and their number
    std::vector<float> nearest_m_;      ///< of each bin; 0 where there is none
    std::vector<float> farthest_m_;     ///< likewise
    double longest_m_ = 0.0;
};

template <typename Predicate>
bool RayImage::anyAround(const Eigen::Vector3d& direction, double angle_rad,
                         double length_m, Predicate&& isWanted) const {
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double depth = (face % 2 == 0 ? 1 : -1) * direction[axis];
        // Rays of a face are within 0.956 rad of its axis. Seen from it, the cone reaches
        // to tan(theta + angle), theta being that of its own axis.
        if (!(depth > std::max(0.0, std::cos(0.956 + angle_rad)))) continue;
        const double sine = std::sin(angle_rad),
                     end = depth * std::cos(angle_rad) -
                           std::sqrt(std::max(0.0, 1 - depth * depth)) * sine;
        const double u = direction[(axis + 1) % 3] / depth,
                     v = direction[(axis + 2) % 3] / depth,
                     wide = end > 0.01 ? sine / (depth * end) : 100.0;
        if (!(std::abs(u) - wide < 1 && std::abs(v) - wide < 1)) continue;
        for (int row = binAt(u - wide); row <= binAt(u + wide); ++row)
            for (int col = binAt(v - wide); col <= binAt(v + wide); ++col) {
                const std::size_t bin = numberOf(face, row, col);
                if (!(double(farthest_m_[bin]) >= length_m)) continue;
                for (std::uint32_t k = first_[bin]; k < first_[bin + 1]; ++k)
                    if (isWanted(rays_[k])) return true;
            }
    }
    return false;
}

}  // namespace hgmm
