#pragma once
#include <Eigen/Core>
#include <memory>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// How a GPOctoMap is made. "Thesis" is section 4.4.1, "paper" is Wang and Englot (2016)
/// with their published code, "search" means that the best found on five recordings was
/// taken.
struct GpOctomapParams {
    /// Edge of a voxel [m], > 0. Thesis: 15 cm in the mine; in the room that of OctoMap.
    double resolution_m = 0.05;
    /// Characteristic length of the kernel [m], > 0. Thesis: 10 cm in the room, 30 cm in
    /// the mine, two voxels each.
    double length_m = 0.1;
    /// Prior standard deviation of a label [1], > 0. Thesis.
    double sigmaF = 0.5;
    /// Standard deviation of the noise of a label [1], >= 1e-3 sigmaF. Search; paper 0.1.
    double noise = 0.2;
    /// Variance at which evidence saturates [1], > 0. Search: with the paper's 1e-3, walls
    /// that hundreds of scans saw are worn away by the rays that graze them.
    double minVariance = 1e-4;
    /// A voxel of a larger variance is unknown [1], in [minVariance, sigmaF^2]. Search.
    double maxKnownVariance = 0.2;
    /// Gain of the logistic squash of the evidence's share of its saturation [1], > 0.
    /// Search; paper 100 at its minVariance.
    double gain = 300.0;
    /// Eight siblings are merged once all are occupied with at least this probability, or
    /// all free, (0.5, 1). Search: merged voxels never part again, and the paper's 0.7
    /// merges walls seen once with the air before them.
    double mergeProbability = 0.99;
    /// Distance of free samples along a ray [m], >= resolution_m / 100. Search.
    double freeSpacing_m = 0.075;
    /// Edge of the cells that training points are thinned to [m], >= resolution_m / 100.
    /// Search; paper: the resolution.
    double sampleSpacing_m = 0.1;
    /// A block has 2^blockDepth voxels each way, [1, 4]. Paper.
    int blockDepth = 2;
    /// Training points of a block, at most [count], [1, 4000].
    int maxBlockPoints = 1000;

    /// The defaults for a resolution [m]: the lengths grow with it.
    static GpOctomapParams atResolution(double resolution_m);
    /// What the paper's published code uses at a resolution [m], where it differs: coarser
    /// samples, evidence that saturates early, voxels that merge early.
    static GpOctomapParams asPublished(double resolution_m);
    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// What a voxel's label is believed to be: +1 is occupied, -1 free.
struct GpBelief {
    double mean = 0.0;
    double variance = 0.0;  ///< of the latent label, without noise
};

/// Occupancy by local Gaussian processes. A scan's hits (label +1) and samples along its
/// rays (label -1) are parted into blocks; each block's GP predicts the voxels of its own
/// block and of the six that share a face with it, and a Bayesian Committee Machine fuses
/// the predictions of all blocks and scans. The voxels of a block are the leaves of an
/// octree whose siblings are merged once they agree.
class GpOctomapBaseline : public Baseline {
 public:
    /// @param resolution_m edge of a voxel [m], > 0
    explicit GpOctomapBaseline(double resolution_m);
    /// Throws std::invalid_argument naming the parameter that is out of range.
    explicit GpOctomapBaseline(const GpOctomapParams& params);
    ~GpOctomapBaseline() override;

    std::string className() const override { return "hgmm::evaluation::GpOctomapBaseline"; }
    std::string source() const override;
    std::vector<std::pair<std::string, double>> options() const override;
    void insert(const Scan& scan) override;
    void query(const Eigen::Vector3d* points_map, std::size_t n,
               Answer* answers) const override;
    /// Leaves and blocks, with the hash table that holds them.
    std::size_t liveBytes() const override;

    /// Of the voxel that holds a point [m, map frame]; the prior where nothing was seen.
    GpBelief beliefAt(const Eigen::Vector3d& point_map) const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hgmm::evaluation
