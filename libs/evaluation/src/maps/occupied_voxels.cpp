#include "hgmm/evaluation/occupied_voxels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace hgmm::evaluation {
namespace {

/// Value below which a share of the coordinates along one axis lies.
double quantile(std::vector<double>& values, double share) {
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(
                                          share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

}  // namespace

VoxelGrid gridAround(const Points& points_map, double edge_m, double outermostShare,
                     std::size_t maxVoxels) {
    if (points_map.empty()) throw std::invalid_argument("voxel grid: no points");
    if (!(edge_m > 0.0)) throw std::invalid_argument("voxel grid: edge must be positive");
    if (!(outermostShare >= 0.0 && outermostShare < 0.5))
        throw std::invalid_argument("voxel grid: outermost share must be in [0, 0.5)");
    VoxelGrid grid;
    grid.edge_m = edge_m;
    double voxels = 1.0;
    std::vector<double> values(points_map.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(points_map.begin(), points_map.end(), values.begin(),
                       [axis](const Eigen::Vector3d& p) { return p[axis]; });
        const double first = std::floor(quantile(values, outermostShare) / edge_m);
        const double last = std::floor(quantile(values, 1.0 - outermostShare) / edge_m);
        grid.min_map[axis] = first * edge_m;
        voxels *= last - first + 1.0;
        if (!(voxels <= static_cast<double>(maxVoxels)))
            throw std::invalid_argument("voxel grid: more than " +
                                        std::to_string(maxVoxels) +
                                        " voxels of this edge; take a longer one");
        grid.count[axis] = static_cast<int>(last - first) + 1;
    }
    return grid;
}

Points occupiedVoxels(const BatchQuery& query, const VoxelGrid& grid) {
    Points occupied, batch;
    std::vector<Answer> answers(kQueryBatch);
    const auto askBatch = [&] {
        query(batch.data(), batch.size(), answers.data());
        for (std::size_t i = 0; i < batch.size(); ++i)
            if (!answers[i].unknown && answers[i].probability > 0.5)
                occupied.push_back(batch[i]);
        batch.clear();
    };
    batch.reserve(kQueryBatch);
    for (int x = 0; x < grid.count.x(); ++x)
        for (int y = 0; y < grid.count.y(); ++y)
            for (int z = 0; z < grid.count.z(); ++z) {
                batch.push_back(grid.min_map +
                                grid.edge_m * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5));
                if (batch.size() == kQueryBatch) askBatch();
            }
    askBatch();
    return occupied;
}

}  // namespace hgmm::evaluation
