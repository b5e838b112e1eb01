#include "maps/gp_octomap_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hgmm/evaluation/voxel_hash.h"

namespace hgmm::evaluation::gp_octomap {
namespace {

constexpr int kBits = 21;

/// Replaces the points of each cell by their mean; cells in the order of their first
/// points.
class SplitPolicy {
 public:
    explicit SplitPolicy(const GpOctomapParams& params) : edge_m_(params.sampleSpacing_m) {}

    void add(const Eigen::Vector3d& point_m) {
        if (!hasVoxel(point_m, edge_m_)) return;
        Cell& cell = cells_.cell(cells_.numberOf(voxelOf(point_m, edge_m_)));
        cell.sum += point_m;
        cell.count += 1.0;
    }

    std::vector<Eigen::Vector3d> means() const {
        std::vector<Eigen::Vector3d> result;
        result.reserve(cells_.size());
        for (std::size_t i = 0; i < cells_.size(); ++i)
            result.push_back(cells_.cell(i).sum / cells_.cell(i).count);
        return result;
    }

 private:
    struct Cell {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        double count = 0.0;
    };

    double edge_m_;
    VoxelHash<Cell> cells_;
};

std::vector<Eigen::Vector3d> hitsOf(const Scan& scan, const GpOctomapParams& params) {
    SplitPolicy hits(params);
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const Eigen::Vector3d p_sensor(scan.x[i], scan.y[i], scan.z[i]);
        if (p_sensor.squaredNorm() > 0.0)
            hits.add(scan.T_map_sensor.R * p_sensor + scan.T_map_sensor.t);
    }
    return hits.means();
}

std::vector<Eigen::Vector3d> freeSamples(const std::vector<Eigen::Vector3d>& hits_map,
                                         const Eigen::Vector3d& sensor_map,
                                         const GpOctomapParams& params) {
    SplitPolicy samples(params);
    for (const Eigen::Vector3d& hit : hits_map) {
        const Eigen::Vector3d toSensor = sensor_map - hit;
        const double range_m = toSensor.norm();
        const auto count = static_cast<std::int64_t>(range_m / params.freeSpacing_m);
        for (std::int64_t i = 1; i <= count; ++i)
            samples.add(
                hit + toSensor * (params.freeSpacing_m / range_m * static_cast<double>(i)));
    }
    return samples.means();
}

/// A training point, by the block that it lies in.
struct Sample {
    BlockKey key;
    Eigen::Vector3d point;
    double label;
};

void append(const std::vector<Eigen::Vector3d>& points_map, double label, double edge_m,
            std::vector<Sample>& samples) {
    Place place;
    for (const Eigen::Vector3d& p : points_map)
        if (placeAt(p, edge_m, kMaxPlace, place))
            samples.push_back({keyOf(place), p, label});
}

BlockSamples toBlock(const Sample* first, std::size_t n, int maxPoints) {
    const std::size_t kept = std::min(n, static_cast<std::size_t>(maxPoints));
    const auto columns = static_cast<Eigen::Index>(kept);
    BlockSamples block{first->key, PointMatrix(3, columns), Eigen::VectorXd(columns)};
    for (std::size_t i = 0; i < kept; ++i) {
        const Sample& sample = first[i * n / kept];
        block.points_m.col(static_cast<Eigen::Index>(i)) = sample.point;
        block.labels[static_cast<Eigen::Index>(i)] = sample.label;
    }
    return block;
}

}  // namespace

BlockKey keyOf(const Place& place) {
    BlockKey key = 0;
    for (int axis = 0; axis < 3; ++axis)
        key = key << kBits | static_cast<BlockKey>(place[axis] + (1 << (kBits - 1)));
    return key;
}

Place placeOf(BlockKey key) {
    Place place;
    for (int axis = 2; axis >= 0; --axis, key >>= kBits)
        place[axis] =
            static_cast<std::int64_t>(key & ((1U << kBits) - 1)) - (1 << (kBits - 1));
    return place;
}

bool placeAt(const Eigen::Vector3d& point_m, double edge_m, std::int64_t limit,
             Place& place) {
    const Eigen::Array3d cell = (point_m.array() / edge_m).floor();
    // Written so that NaN fails.
    if (!(cell.abs() <= static_cast<double>(limit)).all()) return false;
    place = cell.cast<std::int64_t>().matrix();
    return true;
}

std::vector<BlockSamples> samplesOf(const Scan& scan, const GpOctomapParams& params) {
    const double edge_m = std::ldexp(params.resolution_m, params.blockDepth);
    const std::vector<Eigen::Vector3d> hits = hitsOf(scan, params);
    std::vector<Sample> samples;
    append(hits, 1.0, edge_m, samples);
    append(freeSamples(hits, scan.T_map_sensor.t, params), -1.0, edge_m, samples);
    std::stable_sort(samples.begin(), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.key < b.key; });
    std::vector<BlockSamples> blocks;
    for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
        while (end < samples.size() && samples[end].key == samples[begin].key) ++end;
        blocks.push_back(toBlock(&samples[begin], end - begin, params.maxBlockPoints));
    }
    return blocks;
}

}  // namespace hgmm::evaluation::gp_octomap
