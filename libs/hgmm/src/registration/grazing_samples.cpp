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

struct SampleRay {
    Eigen::Vector3d direction;  ///< unit vector; zero for a sample at the sensor
    double range_m = 0.0;
};

/// Rays in cells of a cube about the sensor, by direction, so that those beside are found.
class DirectionCells {
 public:
    explicit DirectionCells(const Mixture<3>& samples_sensor) {
        rays_.reserve(samples_sensor.size());
        for (std::size_t i = 0; i < samples_sensor.size(); ++i) {
            const Eigen::Vector3d point = samples_sensor.meanAt(i);
            const double range_m = point.norm();
            if (!(range_m > 0.0)) {
                rays_.push_back({Eigen::Vector3d::Zero(), 0.0});
                continue;
            }
            rays_.push_back({point / range_m, range_m});
            cells_[keyOf(cellOf(rays_.back().direction))].push_back(std::uint32_t(i));
        }
    }

    const SampleRay& ray(std::size_t i) const { return rays_[i]; }

    /// Calls visit(ray, apart_rad) for every other sample beside a sample.
    template <typename Visitor>
    void visitBeside(std::size_t i, const Visitor& visit) const {
        if (rays_[i].range_m == 0.0) return;
        const Eigen::Vector3d& u = rays_[i].direction;
        const Eigen::Vector3i middle = cellOf(u);
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    const auto found =
                        cells_.find(keyOf(middle + Eigen::Vector3i(x, y, z)));
                    if (found == cells_.end()) continue;
                    for (const std::uint32_t j : found->second) {
                        const double square = (rays_[j].direction - u).squaredNorm();
                        if (j != i && square < kBeside_rad * kBeside_rad)
                            visit(rays_[j], std::sqrt(square));
                    }
                }
    }

 private:
    static Eigen::Vector3i cellOf(const Eigen::Vector3d& u) {
        return (u / kBeside_rad).array().floor().cast<int>();
    }
    static std::int32_t keyOf(const Eigen::Vector3i& cell) {
        return ((cell.x() + 32) << 14) + ((cell.y() + 32) << 7) + cell.z() + 32;
    }

    std::vector<SampleRay> rays_;
    std::unordered_map<std::int32_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

std::vector<bool> areGrazing(const Mixture<3>& samples_sensor,
                             const std::vector<std::size_t>& asked) {
    const DirectionCells cells(samples_sensor);
    std::vector<bool> grazing;
    for (const std::size_t i : asked) {
        const SampleRay& own = cells.ray(i);
        double all = 0, within = 0, nearer = 0;
        cells.visitBeside(i, [&](const SampleRay& other, double apart_rad) {
            const double reach_m = kScatter_m + own.range_m * apart_rad / kGrazingSine;
            const double away2 =
                (other.range_m * other.direction - own.range_m * own.direction)
                    .squaredNorm();
            all += 1;
            if (away2 < reach_m * reach_m)
                within += 1;
            else if (other.range_m < own.range_m)
                nearer += 1;
        });
        grazing.push_back(all > 0 && within < kFew * all && nearer > kNearer * all);
    }
    return grazing;
}

}  // namespace hgmm
