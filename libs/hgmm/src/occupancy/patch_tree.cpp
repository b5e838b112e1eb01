#include "occupancy/patch_tree.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace hgmm {

namespace {

/// Where lanes without a patch or a child are [m]: farther than anything that is asked for.
constexpr float kNowhere_m = 1e15F;

/// Boxes are larger by this share of their numbers, so that rounding does not put a patch
/// outside of its own.
constexpr float kRounding = 4e-6F;

Float4 broadcast(float v) {
    return Float4{v, v, v, v};
}
Float4 positive(Float4 v) {
    const Int4 mask = v > 0;
    return Float4(Int4(v) & mask);
}
Float4 magnitude(Float4 v) {
    return Float4(Int4(v) & 0x7FFFFFFF);
}

/// Children of a node that are still to be looked at, the nearest on top.
struct Pending {
    std::int32_t child;
    float squaredDistance_m2;
};

}  // namespace

template <int D>
PatchTree<D>::PatchTree(const Mixture<3>& mixture) {
    patches_.reserve(mixture.size());
    for (std::uint32_t i = 0; i < mixture.size(); ++i)
        if (const auto patch = patchOf<D>(mixture, i)) patches_.push_back(*patch);
    if (patches_.empty()) return;
    leaves_.reserve((patches_.size() + 3) / 4);
    root_ = build(0, static_cast<std::uint32_t>(patches_.size())).child;
}

template <int D>
std::uint32_t PatchTree<D>::halve(std::uint32_t begin, std::uint32_t end) {
    if (end - begin <= 4) return end;
    Point low = patches_[begin].mean, high = low;
    for (std::uint32_t i = begin; i < end; ++i)
        for (int d = 0; d < D; ++d) {
            low[d] = std::min(low[d], patches_[i].mean[d]);
            high[d] = std::max(high[d], patches_[i].mean[d]);
        }
    int widest = 0;
    for (int d = 1; d < D; ++d)
        if (high[d] - low[d] > high[widest] - low[widest]) widest = d;
    const std::uint32_t middle = begin + ((end - begin) / 2 + 3) / 4 * 4;
    // By index where means coincide, so that the tree is the same everywhere.
    std::nth_element(patches_.begin() + begin, patches_.begin() + middle,
                     patches_.begin() + end, [widest](const Patch& a, const Patch& b) {
                         return std::tie(a.mean[widest], a.component) <
                                std::tie(b.mean[widest], b.component);
                     });
    return middle;
}

template <int D>
auto PatchTree<D>::addLeaf(std::uint32_t begin, std::uint32_t end) -> Subtree {
    Subtree made;
    // Ranges begin at multiples of four, so slots give the leaf.
    const std::size_t at = begin / 4;
    made.child = ~static_cast<std::int32_t>(at);
    if (leaves_.size() <= at) leaves_.resize(at + 1);
    Leaf& leaf = leaves_[at];
    made.low.fill(kNowhere_m);
    made.high.fill(-kNowhere_m);
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
        const bool used = begin + lane < end;
        const Patch patch = used ? patches_[begin + lane] : Patch{};
        leaf.component[lane] = used ? patch.component : SurfaceDistance::kNone;
        for (int d = 0; d < D; ++d) {
            leaf.mean[d][lane] = used ? patch.mean[d] : kNowhere_m;
            leaf.halfEdge[d][lane] = patch.halfEdge[d];
            // Without a patch, axes of length 1 let the mean be as far as it is.
            for (int a = 0; a < D; ++a)
                leaf.axes[a][d][lane] = used ? patch.axes[a][d] : float(a == d);
            if (!used) continue;
            const float reach = patch.reach(d);
            const float margin = kRounding * (reach + std::abs(patch.mean[d]));
            made.low[d] = std::min(made.low[d], patch.mean[d] - reach - margin);
            made.high[d] = std::max(made.high[d], patch.mean[d] + reach + margin);
        }
        made.thickest_m = std::max(made.thickest_m, patch.normalStd_m);
    }
    return made;
}

template <int D>
auto PatchTree<D>::build(std::uint32_t begin, std::uint32_t end) -> Subtree {
    if (end - begin <= 4) return addLeaf(begin, end);
    const std::uint32_t middle = halve(begin, end);
    const std::array<std::uint32_t, 5> bounds{begin, halve(begin, middle), middle,
                                              halve(middle, end), end};
    const std::size_t at = nodes_.size();
    nodes_.emplace_back();
    Subtree made;
    made.low.fill(kNowhere_m);
    made.high.fill(-kNowhere_m);
    for (int lane = 0; lane < 4; ++lane) {
        Subtree child;
        child.low.fill(kNowhere_m);
        child.high.fill(kNowhere_m);
        if (bounds[lane] < bounds[lane + 1]) {
            child = build(bounds[lane], bounds[lane + 1]);
            made.thickest_m = std::max(made.thickest_m, child.thickest_m);
            for (int d = 0; d < D; ++d) {
                made.low[d] = std::min(made.low[d], child.low[d]);
                made.high[d] = std::max(made.high[d], child.high[d]);
            }
        }
        for (int d = 0; d < D; ++d) {
            nodes_[at].low[d][lane] = child.low[d];
            nodes_[at].high[d][lane] = child.high[d];
        }
        nodes_[at].thickest_m[lane] = child.thickest_m;
        nodes_[at].child[lane] = child.child;
    }
    made.child = static_cast<std::int32_t>(at);
    return made;
}

template <int D>
inline Float4 PatchTree<D>::squaredDistances(const Leaf& leaf, const Point& point) {
    Lanes offset;
    for (int d = 0; d < D; ++d) offset[d] = broadcast(point[d]) - leaf.mean[d];
    Float4 sum = broadcast(0.F);
    for (int a = 0; a < D; ++a) {
        Float4 along = leaf.axes[a][0] * offset[0];
        for (int d = 1; d < D; ++d) along += leaf.axes[a][d] * offset[d];
        if (a > 0) along = positive(magnitude(along) - leaf.halfEdge[a]);
        sum += along * along;
    }
    return sum;
}

template <int D>
inline Float4 PatchTree<D>::squaredDistances(const Node& node, const Point& point) {
    Float4 sum = broadcast(0.F);
    for (int d = 0; d < D; ++d) {
        const Float4 p = broadcast(point[d]);
        // A box is never left on both sides.
        const Float4 out = positive(node.low[d] - p) + positive(p - node.high[d]);
        sum += out * out;
    }
    // Rounding must not make a box seem farther away than what it holds.
    return sum * (1.F - kRounding);
}

template <int D>
inline void PatchTree<D>::compare(std::uint32_t leaf, const Point& point,
                                  Nearest& best) const {
    const Float4 squared = squaredDistances(leaves_[leaf], point);
    for (std::uint32_t lane = 0; lane < 4; ++lane) {
        if (squared[lane] > best.squaredDistance_m2) continue;
        const std::uint32_t component = leaves_[leaf].component[lane];
        if (squared[lane] < best.squaredDistance_m2 || component < best.component)
            best = {squared[lane], component, 4 * leaf + lane};
    }
}

template <int D>
auto PatchTree<D>::nearest(const Point& point, float maxDistance_m,
                           std::uint32_t guess) const -> Nearest {
    Nearest best;
    best.squaredDistance_m2 = maxDistance_m * maxDistance_m;
    if (patches_.empty()) return best;
    if (guess != SurfaceDistance::kNone) compare(guess / 4, point, best);
    // A level of the tree adds three, and halves what is left twice.
    std::array<Pending, 64> pending;
    std::size_t count = 0;
    pending[count++] = {root_, 0.F};
    while (count > 0) {
        const Pending next = pending[--count];
        if (next.squaredDistance_m2 > best.squaredDistance_m2) continue;
        if (next.child < 0) {
            compare(static_cast<std::uint32_t>(~next.child), point, best);
            continue;
        }
        const Node& node = nodes_[static_cast<std::size_t>(next.child)];
        const Float4 squared = squaredDistances(node, point);
        const std::size_t first = count;
        for (int lane = 0; lane < 4; ++lane) {
            if (squared[lane] > best.squaredDistance_m2) continue;
            std::size_t at = count++;
            for (; at > first && pending[at - 1].squaredDistance_m2 < squared[lane]; --at)
                pending[at] = pending[at - 1];
            pending[at] = {node.child[lane], squared[lane]};
        }
    }
    return best;
}

template <int D>
std::size_t PatchTree<D>::liveBytes() const {
    return patches_.capacity() * sizeof(Patch) + leaves_.capacity() * sizeof(Leaf) +
           nodes_.capacity() * sizeof(Node);
}

template class PatchTree<2>;
template class PatchTree<3>;

}  // namespace hgmm
