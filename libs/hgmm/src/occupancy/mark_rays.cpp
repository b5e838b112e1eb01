#include "occupancy/mark_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/hash_table.h"
#include "base/power_of_two.h"

namespace hgmm {

namespace {

/// Width of a bin of directions in cells, where its lattice ends: across, two rays of a bin
/// are at most a cell apart.
constexpr double kCellsPerBin = 0.7071067811865476;
/// So that a direction's bin fits into its key.
constexpr double kMostBins = 1e7;

struct MarkingRay {
    Eigen::Vector3d direction;  ///< unit vector
    double length_m;            ///< as far as it marks cells
};

std::vector<MarkingRay> markingRays(const Mixture<3>& samples, const ScanSamples& scan,
                                    const Pose& T_local_sensor,
                                    const Coverage::Rays& rays) {
    std::vector<MarkingRay> marking;
    marking.reserve(samples.size() + scan.clearedRays_sensor.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d ray = samples.meanAt(i) - T_local_sensor.t;
        const double range_m = ray.norm();
        if (range_m > 0)
            marking.push_back({ray / range_m, range_m - rays.leftOut(range_m)});
    }
    for (const ClearedRay& ray : scan.clearedRays_sensor)
        marking.push_back(
            {T_local_sensor.R * ray.direction.cast<double>(), double(ray.length_m)});
    return marking;
}

/// How far the lattices of one scan are marked, by direction. Many rays pass the same cells
/// near the sensor: the first one of a bin of directions is walked there, and what others
/// reach farther.
class MarkedBins {
 public:
    MarkedBins(const std::vector<MarkingRay>& marking, const Coverage::Rays& rays) {
        double longest_m = 0.0;
        for (const MarkingRay& ray : marking) longest_m = std::max(longest_m, ray.length_m);
        rays.forEachStretch(longest_m, [&](const Coverage::Stretch& stretch) {
            const double bins = stretch.to_m / (kCellsPerBin * powerOfTwo(stretch.octave));
            lattices_.push_back({stretch, std::min(bins, kMostBins)});
        });
        markedTo_m_.reserve(marking.size());
    }

    void mark(const MarkingRay& ray, const Eigen::Vector3d& origin,
              const Coverage::Rays& rays, Coverage& coverage) {
        // By the faces of a cube around the sensor.
        int axis = 0;
        const Eigen::Vector3d& d = ray.direction;
        const double depth = d.cwiseAbs().maxCoeff(&axis);
        const double u = d[(axis + 1) % 3] / depth + 1, v = d[(axis + 2) % 3] / depth + 1;
        std::uint64_t face = static_cast<std::uint64_t>(2 * axis + (d[axis] < 0 ? 1 : 0));
        for (const Lattice& lattice : lattices_) {
            const Coverage::Stretch& stretch = lattice.stretch;
            if (!(ray.length_m > stretch.from_m)) return;
            const auto key = face << 50U |
                             static_cast<std::uint64_t>(u * lattice.binsPerUnit) << 25U |
                             static_cast<std::uint64_t>(v * lattice.binsPerUnit);
            face += kFaces;
            double& marked_m = *markedTo_m_.tryEmplace(key, 0.0).first;
            const double to_m = std::min(ray.length_m, stretch.to_m);
            if (to_m <= marked_m) continue;
            const double from_m =
                std::max(stretch.start_m(), marked_m - powerOfTwo(stretch.octave));
            coverage.markStretch(stretch.octave, origin + from_m * d, origin + to_m * d,
                                 rays);
            marked_m = to_m;
        }
    }

 private:
    static constexpr std::uint64_t kFaces = 6;

    struct Lattice {
        Coverage::Stretch stretch;
        double binsPerUnit;  ///< half of those along an edge of a face
    };
    struct Keys {
        static std::uint64_t unused() { return ~std::uint64_t{0}; }
        static std::uint64_t hash(std::uint64_t key) {
            return (key * 0x9E3779B97F4A7C15U) >> 32U;
        }
    };

    std::vector<Lattice> lattices_;
    HashTable<std::uint64_t, double, Keys> markedTo_m_;
};

}  // namespace

void markRays(const Mixture<3>& samples, const ScanSamples& scan,
              const Pose& T_local_sensor, const CoverageParams& params,
              Coverage& coverage) {
    const Coverage::Rays rays(params, scan.raySpacing_rad,
                              T_local_sensor.R * scan.normalOfRays_sensor);
    const std::vector<MarkingRay> marking =
        markingRays(samples, scan, T_local_sensor, rays);
    MarkedBins bins(marking, rays);
    for (const MarkingRay& ray : marking) bins.mark(ray, T_local_sensor.t, rays, coverage);
}

}  // namespace hgmm
