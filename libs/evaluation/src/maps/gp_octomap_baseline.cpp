#include "hgmm/evaluation/gp_octomap_baseline.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "maps/gp_octomap_block.h"
#include "maps/gp_octomap_samples.h"

namespace hgmm::evaluation {
namespace {

using namespace gp_octomap;

void require(bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("GpOctomapParams::") + what);
}

bool isPositive(double v) {
    return v > 0.0 && std::isfinite(v);
}

struct KeyHash {
    std::size_t operator()(BlockKey key) const {
        key *= 0x9E3779B97F4A7C15ULL;
        return static_cast<std::size_t>(key ^ key >> 32U);
    }
};

/// A block and the six that share a face with it.
std::vector<BlockKey> withNeighbours(BlockKey key) {
    std::vector<BlockKey> keys{key};
    const Place place = placeOf(key);
    for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
            Place neighbour = place;
            neighbour[axis] += step;
            keys.push_back(keyOf(neighbour));
        }
    return keys;
}

}  // namespace

GpOctomapParams GpOctomapParams::atResolution(double resolution_m) {
    GpOctomapParams params;
    params.resolution_m = resolution_m;
    params.length_m = 2.0 * resolution_m;
    params.freeSpacing_m = 1.5 * resolution_m;
    params.sampleSpacing_m = 2.0 * resolution_m;
    return params;
}

GpOctomapParams GpOctomapParams::asPublished(double resolution_m) {
    GpOctomapParams params = atResolution(resolution_m);
    params.noise = 0.3;
    params.minVariance = 1e-3;
    params.gain = 100.0;
    params.mergeProbability = 0.7;
    params.freeSpacing_m = 2.0 * resolution_m;
    params.sampleSpacing_m = resolution_m;
    return params;
}

void GpOctomapParams::validate() const {
    require(isPositive(resolution_m), "resolution_m must be > 0");
    require(isPositive(length_m), "length_m must be > 0");
    require(isPositive(sigmaF), "sigmaF must be > 0");
    // Keeps Cholesky far from rounding.
    require(noise >= 1e-3 * sigmaF && std::isfinite(noise), "noise must be >= 1e-3 sigmaF");
    require(isPositive(minVariance), "minVariance must be > 0");
    require(maxKnownVariance >= minVariance && maxKnownVariance <= sigmaF * sigmaF,
            "maxKnownVariance must be in [minVariance, sigmaF^2]");
    require(isPositive(gain), "gain must be > 0");
    require(mergeProbability > 0.5 && mergeProbability < 1.0,
            "mergeProbability must be in (0.5, 1)");
    require(freeSpacing_m >= resolution_m / 100 && std::isfinite(freeSpacing_m),
            "freeSpacing_m must be >= resolution_m / 100");
    require(sampleSpacing_m >= resolution_m / 100 && std::isfinite(sampleSpacing_m),
            "sampleSpacing_m must be >= resolution_m / 100");
    require(blockDepth >= 1 && blockDepth <= 4, "blockDepth must be in [1, 4]");
    require(maxBlockPoints >= 1 && maxBlockPoints <= 4000,
            "maxBlockPoints must be in [1, 4000]");
}

struct GpOctomapBaseline::Impl {
    explicit Impl(const GpOctomapParams& p)
        : params(p), fusion(p), edge_m(std::ldexp(p.resolution_m, p.blockDepth)) {}

    Eigen::Vector3d corner(BlockKey key) const {
        return placeOf(key).cast<double>() * edge_m;
    }

    /// Lets what one block's GP predicts of another block be known there.
    void predict(const LocalGp& gp, BlockKey key, Predictions& predictions) {
        Block& block =
            blocks.try_emplace(key, params.blockDepth, fusion.prior()).first->second;
        gp.predict(block.centres(corner(key), params.resolution_m), predictions);
        block.fuse(predictions, fusion);
    }

    /// Of the voxel that holds a point; none where nothing was seen.
    const Information* find(const Eigen::Vector3d& point_map) const {
        Place place;
        if (!placeAt(point_map, edge_m, kMaxPlace + 1, place)) return nullptr;
        const BlockKey key = keyOf(place);
        const auto block = blocks.find(key);
        if (block == blocks.end()) return nullptr;
        const Eigen::Array3i voxel =
            ((point_map - corner(key)) / params.resolution_m).array().cast<int>();
        // A point on a face may be rounded into the next block.
        const Eigen::Array3i inside = voxel.max(0).min((1 << params.blockDepth) - 1);
        return &block->second.at(inside.x(), inside.y(), inside.z());
    }

    GpOctomapParams params;
    Fusion fusion;
    double edge_m;  ///< of a block
    std::unordered_map<BlockKey, Block, KeyHash> blocks;
};

GpOctomapBaseline::GpOctomapBaseline(double resolution_m)
    : GpOctomapBaseline(GpOctomapParams::atResolution(resolution_m)) {}

GpOctomapBaseline::GpOctomapBaseline(const GpOctomapParams& params) {
    params.validate();
    impl_ = std::make_unique<Impl>(params);
}

GpOctomapBaseline::~GpOctomapBaseline() = default;

std::string GpOctomapBaseline::source() const {
    return "Wang and Englot, Fast, accurate Gaussian process occupancy maps via test-data "
           "octrees and nested Bayesian fusion, ICRA 2016";
}

std::vector<std::pair<std::string, double>> GpOctomapBaseline::options() const {
    const GpOctomapParams& p = impl_->params;
    return {{"resolution", p.resolution_m},
            {"length", p.length_m},
            {"sigmaF", p.sigmaF},
            {"noise", p.noise},
            {"minVariance", p.minVariance},
            {"maxKnownVariance", p.maxKnownVariance},
            {"gain", p.gain},
            {"mergeProbability", p.mergeProbability},
            {"freeSpacing", p.freeSpacing_m},
            {"sampleSpacing", p.sampleSpacing_m},
            {"blockDepth", p.blockDepth},
            {"maxBlockPoints", p.maxBlockPoints}};
}

void GpOctomapBaseline::insert(const Scan& scan) {
    const GpOctomapParams& p = impl_->params;
    const Kernel kernel{p.length_m, p.sigmaF, p.noise};
    std::set<BlockKey> changed;
    Predictions predictions;
    for (BlockSamples& samples : samplesOf(scan, p)) {
        const LocalGp gp(std::move(samples.points_m), samples.labels, kernel);
        for (const BlockKey key : withNeighbours(samples.key)) {
            impl_->predict(gp, key, predictions);
            changed.insert(key);
        }
    }
    for (const BlockKey key : changed) impl_->blocks.at(key).prune(impl_->fusion);
}

void GpOctomapBaseline::query(const Eigen::Vector3d* points_map, std::size_t n,
                              Answer* answers) const {
    for (std::size_t i = 0; i < n; ++i) {
        answers[i] = Answer{};
        const Information* information = impl_->find(points_map[i]);
        if (!information || !impl_->fusion.isKnown(*information)) continue;
        answers[i] = {impl_->fusion.probability(*information), false};
    }
}

std::size_t GpOctomapBaseline::liveBytes() const {
    std::size_t bytes = impl_->blocks.bucket_count() * sizeof(void*);
    // The table chains its nodes, and each holds a pointer to the next.
    for (const auto& entry : impl_->blocks)
        bytes += sizeof(entry) + sizeof(void*) + entry.second.heapBytes();
    return bytes;
}

GpBelief GpOctomapBaseline::beliefAt(const Eigen::Vector3d& point_map) const {
    const Information* information = impl_->find(point_map);
    return impl_->fusion.toBelief(information ? *information : impl_->fusion.prior());
}

}  // namespace hgmm::evaluation
