#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/evaluation/gp_octomap_baseline.h"
#include "maps/gp_octomap_gp.h"

namespace hgmm::evaluation::gp_octomap {

/// Beliefs are kept in information form, where the committee's products are sums.
struct Information {
    float vector = 0.F;     ///< mean over variance
    float precision = 0.F;  ///< one over variance
};

/// How beliefs are fused, and what they say of occupancy.
class Fusion {
 public:
    explicit Fusion(const GpOctomapParams& params);

    Information prior() const;
    /// Bayesian Committee Machine (Tresp 2000): precisions add up, less the prior that each
    /// further member brings along. Evidence saturates at minVariance and at labels of +-1.
    Information fuse(const Information& belief, double mean, double variance) const;
    GpBelief toBelief(const Information& i) const;
    double probability(const Information& i) const;
    bool isKnown(const Information& i) const;
    /// Whether both are surely occupied, or both surely free (mergeProbability).
    bool agree(const Information& a, const Information& b) const;

 private:
    /// +1 surely occupied, -1 surely free, 0 neither.
    int state(const Information& i) const;

    GpOctomapParams params_;
    double priorPrecision_;
    double maxPrecision_;
};

/// A cube of voxels, as the leaves of an octree in Morton order; merged leaves stand for
/// all the voxels below them.
class Block {
 public:
    /// All voxels at `prior`.
    Block(int depth, const Information& prior);

    /// Centres of the leaves [m], in their order.
    PointMatrix centres(const Eigen::Vector3d& corner_m, double resolution_m) const;
    void fuse(const Predictions& predictions, const Fusion& fusion);
    /// Merges eight siblings that agree into their parent, with their mean information.
    void prune(const Fusion& fusion);
    /// Of a voxel, by its place in the block.
    const Information& at(int x, int y, int z) const;
    /// Of the leaves.
    std::size_t heapBytes() const { return leaves_.capacity() * sizeof(Leaf); }

 private:
    struct Leaf {
        std::uint16_t code;   ///< Morton code of its first voxel
        std::uint16_t level;  ///< edge is 2^level voxels
        Information information;
    };

    static bool mergeLastEight(std::vector<Leaf>& leaves, const Fusion& fusion);

    std::vector<Leaf> leaves_;
};

}  // namespace hgmm::evaluation::gp_octomap
