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
    /// Half the angle at the tip of a cone, up to 0.6 rad, without functions of angles,
    /// whose last bits change with the processor.
    struct Cone {
        double sine, cosine;

        static Cone ofSine(double sine) { return {sine, std::sqrt(1 - sine * sine)}; }
        /// Of at most 0.5 rad.
        static Cone ofTangent(double tangent) {
            const double t = std::min(tangent, 0.5463024898437905),
                         cosine = 1 / std::sqrt(1 + t * t);
            return {t * cosine, cosine};
        }
    };

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

    /// Whether isWanted(ray) holds of one of the rays of all bins that reach into a cone
    /// about a direction and hold a ray of at least `length_m`. They are asked in a fixed
    /// order, up to the first of which it holds.
    template <typename Predicate>
    bool anyAround(const Eigen::Vector3d& direction, const Cone& cone, double length_m,
                   Predicate&& isWanted) const;
    /// Calls visit(ray) for all of them.
    template <typename Visitor>
    void visitAround(const Eigen::Vector3d& direction, const Cone& cone, double length_m,
                     Visitor&& visit) const {
        anyAround(direction, cone, length_m, [&](const Ray& ray) {
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
bool RayImage::anyAround(const Eigen::Vector3d& direction, const Cone& cone,
                         double length_m, Predicate&& isWanted) const {
    // Rays of a face are within 0.956 rad of its axis: cosine and sine.
    constexpr double kFaceCosine = 0.5769, kFaceSine = 0.8169;
    const double least = std::max(0.0, kFaceCosine * cone.cosine - kFaceSine * cone.sine);
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double depth = (face % 2 == 0 ? 1 : -1) * direction[axis];
        // Seen from a face, the cone reaches to tan(theta + angle), theta being that of its
        // own axis.
        if (!(depth > least)) continue;
        const double sine = cone.sine,
                     end = depth * cone.cosine -
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
