#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hgmm/evaluation/gp_octomap_baseline.h"
#include "maps/gp_octomap_gp.h"

namespace hgmm::evaluation::gp_octomap {

/// Name of a block: its place on the lattice of blocks, 21 bits an axis.
using BlockKey = std::uint64_t;

/// Places on the lattice of blocks lie within this of the origin [blocks].
constexpr std::int64_t kMaxPlace = (1 << 20) - 2;

using Place = Eigen::Matrix<std::int64_t, 3, 1>;

BlockKey keyOf(const Place& place);
Place placeOf(BlockKey key);

/// Place of a point on the lattice of cells with edge `edge_m`; false if the point is not
/// finite or its place beyond `limit` cells from the origin.
bool placeAt(const Eigen::Vector3d& point_m, double edge_m, std::int64_t limit,
             Place& place);

/// What one scan teaches about one block.
struct BlockSamples {
    BlockKey key;
    PointMatrix points_m;
    Eigen::VectorXd labels;
};

/// The training data of a scan, blocks by rising key. Hits are thinned to the mean of each
/// cell of sampleSpacing_m; along the ray to each of those lie free samples, freeSpacing_m
/// apart counted from the hit, thinned alike. Points that are not finite, that coincide
/// with the sensor, or that lie beyond the lattice are left out. Of a block with more than
/// maxBlockPoints points, as many are taken, evenly over their order.
std::vector<BlockSamples> samplesOf(const Scan& scan, const GpOctomapParams& params);

}  // namespace hgmm::evaluation::gp_octomap
