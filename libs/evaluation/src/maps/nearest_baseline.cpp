#include "hgmm/evaluation/nearest_baseline.h"

#include <cmath>
#include <nanoflann.hpp>

#include "hgmm/evaluation/voxel_hash.h"
#include "maps/scan_points.h"

namespace hgmm::evaluation {

/// The points as nanoflann asks for them, and the index of them all.
struct NearestBaseline::Cloud {
    using Index =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>,
                                            Cloud, 3, std::uint32_t>;

    Eigen::Vector3d origin_map = Eigen::Vector3d::Zero();
    VoxelHash<Eigen::Vector3f> points;  ///< from the origin: maps may lie far out
    std::unique_ptr<Index> index;       ///< none if there were points since

    std::size_t kdtree_get_point_count() const { return points.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return points.cell(i)[static_cast<Eigen::Index>(axis)];
    }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const {
        return false;
    }

    void buildIndex() {
        if (!index && points.size() > 0)
            index = std::make_unique<Index>(3, *this,
                                            nanoflann::KDTreeSingleIndexAdaptorParams(16));
    }
};

NearestBaseline::NearestBaseline() : cloud_(std::make_unique<Cloud>()) {}
NearestBaseline::~NearestBaseline() = default;

std::string NearestBaseline::source() const {
    return "Blanco and Rai, nanoflann, the k-d tree that MRPT's maps of points use";
}

std::vector<std::pair<std::string, double>> NearestBaseline::options() const {
    return {{"scale", kNearScale_m}, {"thinning", kThinning_m}};
}

void NearestBaseline::insert(const Scan& scan) {
    const Points points = finitePointsInMap(scan);
    if (points.empty()) return;
    cloud_->index.reset();
    VoxelHash<Eigen::Vector3f>& kept = cloud_->points;
    if (kept.size() == 0) cloud_->origin_map = scan.T_map_sensor.t;
    for (const Eigen::Vector3d& p_map : points) {
        const Eigen::Vector3d p = p_map - cloud_->origin_map;
        if (!hasVoxel(p, kThinning_m)) continue;
        const std::size_t before = kept.size();
        const std::size_t i = kept.numberOf(voxelOf(p, kThinning_m));
        if (i == before) kept.cell(i) = p.cast<float>();
    }
}

void NearestBaseline::query(const Eigen::Vector3d* points_map, std::size_t n,
                            Answer* answers) const {
    cloud_->buildIndex();
    for (std::size_t i = 0; i < n; ++i) {
        answers[i] = {0.0, true};
        if (!cloud_->index || !points_map[i].allFinite()) continue;
        const Eigen::Vector3d p = points_map[i] - cloud_->origin_map;
        std::uint32_t nearest = 0;
        double squared = 0.0;
        cloud_->index->knnSearch(p.data(), 1, &nearest, &squared);
        answers[i] = {1.0 / (1.0 + std::sqrt(squared) / kNearScale_m), false};
    }
}

std::size_t NearestBaseline::liveBytes() const {
    const std::size_t index = cloud_->index ? cloud_->index->usedMemory(*cloud_->index) : 0;
    return cloud_->points.size() * sizeof(Eigen::Vector3f) + index;
}

}  // namespace hgmm::evaluation
