#include "maps/gp_octomap_block.h"

#include <algorithm>
#include <cmath>

namespace hgmm::evaluation::gp_octomap {
namespace {

constexpr int kMaxDepth = 4;

std::uint16_t mortonCode(int x, int y, int z) {
    int code = 0;
    for (int bit = 0; bit < kMaxDepth; ++bit)
        code |= (x >> bit & 1) << (3 * bit) | (y >> bit & 1) << (3 * bit + 1) |
                (z >> bit & 1) << (3 * bit + 2);
    return static_cast<std::uint16_t>(code);
}

/// The coordinate whose bits stand at `axis` and every third place from there.
int coordinate(std::uint16_t code, int axis) {
    int value = 0;
    for (int bit = 0; bit < kMaxDepth; ++bit)
        value |= (code >> (3 * bit + axis) & 1) << bit;
    return value;
}

}  // namespace

Fusion::Fusion(const GpOctomapParams& params)
    : params_(params),
      priorPrecision_(1.0 / (params.sigmaF * params.sigmaF)),
      maxPrecision_(1.0 / params.minVariance) {}

Information Fusion::prior() const {
    return {0.F, static_cast<float>(priorPrecision_)};
}

Information Fusion::fuse(const Information& belief, double mean, double variance) const {
    const double v = std::max(variance, params_.minVariance);
    const double vector = belief.vector + mean / v;
    const double precision = belief.precision + 1.0 / v - priorPrecision_;
    return {static_cast<float>(std::clamp(vector, -maxPrecision_, maxPrecision_)),
            static_cast<float>(std::clamp(precision, priorPrecision_, maxPrecision_))};
}

GpBelief Fusion::toBelief(const Information& i) const {
    return {i.vector / i.precision, 1.0 / i.precision};
}

double Fusion::probability(const Information& i) const {
    return 1.0 / (1.0 + std::exp(-params_.gain * i.vector / maxPrecision_));
}

bool Fusion::isKnown(const Information& i) const {
    return i.precision * params_.maxKnownVariance >= 1.0;
}

int Fusion::state(const Information& i) const {
    if (!isKnown(i)) return 0;
    const double p = probability(i);
    if (p >= params_.mergeProbability) return 1;
    return 1.0 - p >= params_.mergeProbability ? -1 : 0;
}

bool Fusion::agree(const Information& a, const Information& b) const {
    return state(a) != 0 && state(a) == state(b);
}

Block::Block(int depth, const Information& prior) : leaves_(std::size_t{1} << 3 * depth) {
    std::uint16_t code = 0;
    for (Leaf& leaf : leaves_) leaf = {code++, 0, prior};
}

PointMatrix Block::centres(const Eigen::Vector3d& corner_m, double resolution_m) const {
    PointMatrix result(3, static_cast<Eigen::Index>(leaves_.size()));
    Eigen::Index column = 0;
    for (const Leaf& leaf : leaves_) {
        const double half = 0.5 * (1 << leaf.level);
        for (int axis = 0; axis < 3; ++axis)
            result(axis, column) =
                corner_m[axis] + resolution_m * (coordinate(leaf.code, axis) + half);
        ++column;
    }
    return result;
}

void Block::fuse(const Predictions& predictions, const Fusion& fusion) {
    Eigen::Index i = 0;
    for (Leaf& leaf : leaves_) {
        leaf.information =
            fusion.fuse(leaf.information, predictions.mean[i], predictions.variance[i]);
        ++i;
    }
}

bool Block::mergeLastEight(std::vector<Leaf>& leaves, const Fusion& fusion) {
    if (leaves.size() < 8) return false;
    const auto first = leaves.end() - 8;
    const int level = first->level;
    if (first->code & ((8 << 3 * level) - 1)) return false;
    Information sum;
    for (auto leaf = first; leaf != leaves.end(); ++leaf) {
        if (leaf->level != level || !fusion.agree(first->information, leaf->information))
            return false;
        sum.vector += leaf->information.vector;
        sum.precision += leaf->information.precision;
    }
    first->information = {sum.vector / 8, sum.precision / 8};
    ++first->level;
    leaves.erase(first + 1, leaves.end());
    return true;
}

void Block::prune(const Fusion& fusion) {
    std::vector<Leaf> pruned;
    pruned.reserve(leaves_.size());
    for (const Leaf& leaf : leaves_) {
        pruned.push_back(leaf);
        while (mergeLastEight(pruned, fusion)) continue;
    }
    if (pruned.size() < leaves_.size()) leaves_.assign(pruned.begin(), pruned.end());
    leaves_.shrink_to_fit();
}

const Information& Block::at(int x, int y, int z) const {
    const std::uint16_t code = mortonCode(x, y, z);
    const auto next =
        std::upper_bound(leaves_.begin(), leaves_.end(), code,
                         [](std::uint16_t c, const Leaf& leaf) { return c < leaf.code; });
    return std::prev(next)->information;
}

}  // namespace hgmm::evaluation::gp_octomap
