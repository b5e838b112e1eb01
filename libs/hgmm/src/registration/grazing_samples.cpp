#include "registration/grazing_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace hgmm {

namespace {

/// Rays within this angle are compared: more than what is between two rings of common
/// lidars [rad].
constexpr double kBeside_rad = 0.052;
/// Besides their angle: scatter of samples [m].
constexpr double kScatter_m = 0.05;
/// A sample is grazing if less than this share of the samples beside it is within reach,
constexpr double kFew = 0.65;
/// and this share is nearer to the sensor: a pole has what is behind it on both sides [1].
constexpr double kNearer = 0.2;

/// Directions in cells of a cube about the sensor, so that those beside are found.
class DirectionCells {
 public:
    explicit DirectionCells(const Mixture<3>& samples_sensor) : samples_(samples_sensor) {
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Eigen::Vector3d u = point(i).normalized();
            if (u.allFinite()) cells_[keyOf(cellOf(u))].push_back(std::uint32_t(i));
        }
    }

    Eigen::Vector3d point(std::size_t i) const {
        return {double(samples_.mean[0][i]), double(samples_.mean[1][i]),
                double(samples_.mean[2][i])};
    }

    /// Calls visit(point) for every other sample beside a sample.
    template <typename Visitor>
    void visitBeside(std::size_t i, const Visitor& visit) const {
        const Eigen::Vector3d u = point(i).normalized();
        if (!u.allFinite()) return;
        const Eigen::Vector3i middle = cellOf(u);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    const auto found =
                        cells_.find(keyOf(middle + Eigen::Vector3i(x, y, z)));
                    if (found == cells_.end()) continue;
                    for (const std::uint32_t j : found->second)
                        if (j != i && (point(j).normalized() - u).norm() < kBeside_rad)
                            visit(point(j));
                }
    }

 private:
    static Eigen::Vector3i cellOf(const Eigen::Vector3d& u) {
        return (u / kBeside_rad).array().floor().cast<int>();
    }
    static std::int32_t keyOf(const Eigen::Vector3i& cell) {
        return ((cell.x() + 32) << 14) + ((cell.y() + 32) << 7) + cell.z() + 32;
    }

    const Mixture<3>& samples_;
    std::unordered_map<std::int32_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

std::vector<bool> areGrazing(const Mixture<3>& samples_sensor,
                             const std::vector<std::size_t>& asked) {
    const DirectionCells cells(samples_sensor);
    std::vector<bool> grazing;
    for (const std::size_t i : asked) {
        const Eigen::Vector3d p = cells.point(i);
        const double range_m = p.norm();
        double all = 0, within = 0, nearer = 0;
        cells.visitBeside(i, [&](const Eigen::Vector3d& other) {
            const double other_m = other.norm();
            const double apart_rad = (other / other_m - p / range_m).norm();
            all += 1;
            if ((other - p).norm() < kScatter_m + range_m * apart_rad / kGrazingSine)
                within += 1;
            else if (other_m < range_m)
                nearer += 1;
        });
        grazing.push_back(all > 0 && within < kFew * all && nearer > kNearer * all);
    }
    return grazing;
}

}  // namespace hgmm
