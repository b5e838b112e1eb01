#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/simd.h"
#include "hgmm/mixture.h"
#include "occupancy/surface_patch.h"

namespace hgmm {

/// All patches of a mixture in a tree of bounding boxes, four to a node and four patches to
/// a leaf, so that four are compared at once. Any distance can be asked for; the cost of a
/// query grows with the logarithm of their number.
template <int D>
class PatchTree {
 public:
    using Patch = SurfacePatch<D>;
    using Point = typename Patch::Point;

    struct Nearest {
        float squaredDistance_m2 = std::numeric_limits<float>::infinity();
        std::uint32_t component = SurfaceDistance::kNone;
        std::uint32_t slot = 0;  ///< of the patch in the tree
    };

    /// Data is copied. Components that are not finite have no patch.
    explicit PatchTree(const Mixture<3>& mixture);

    std::size_t size() const { return patches_.size(); }
    const Patch& patch(std::uint32_t slot) const { return patches_[slot]; }

    /// The nearest patch within a distance, the lowest component of equals; component is
    /// kNone if there is none.
    /// @param guess slot of a patch that may be near, or kNone; it spares work and does not
    /// change the answer
    Nearest nearest(const Point& point, float maxDistance_m, std::uint32_t guess) const;

    /// Calls visit(patch) for every patch whose bounding box meets another one, grown by
    /// `sigmas` of the thickest patch nearby.
    template <typename Visitor>
    void visitBox(const Point& low, const Point& high, float sigmas, Visitor&& visit) const;

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    using Lanes = std::array<Float4, D>;
    /// The patches of four successive slots.
    struct Leaf {
        Lanes mean;
        std::array<Lanes, D> axes;
        Lanes halfEdge;  ///< that along the normal is not used
        std::array<std::uint32_t, 4> component;
    };
    struct Node {
        Lanes low, high;
        Float4 thickest_m;                  ///< largest standard deviation along a normal
        std::array<std::int32_t, 4> child;  ///< a node, or ~leaf
    };
    struct Subtree {
        Point low{}, high{};
        float thickest_m = 0.F;
        std::int32_t child = ~0;  ///< of an empty lane: a leaf that is not reached
    };

    Subtree build(std::uint32_t begin, std::uint32_t end);
    /// Puts the patches of a range on either side of a multiple of four slots.
    std::uint32_t halve(std::uint32_t begin, std::uint32_t end);
    Subtree addLeaf(std::uint32_t begin, std::uint32_t end);
    static Float4 squaredDistances(const Leaf& leaf, const Point& point);
    static Float4 squaredDistances(const Node& node, const Point& point);
    void compare(std::uint32_t leaf, const Point& point, Nearest& best) const;

    std::vector<Patch> patches_;  ///< by slot
    std::vector<Leaf> leaves_;
    std::vector<Node> nodes_;
    std::int32_t root_ = 0;
};

template <int D>
template <typename Visitor>
void PatchTree<D>::visitBox(const Point& low, const Point& high, float sigmas,
                            Visitor&& visit) const {
    if (patches_.empty()) return;
    std::vector<std::int32_t> pending{root_};
    while (!pending.empty()) {
        const std::int32_t at = pending.back();
        pending.pop_back();
        if (at < 0) {
            const std::size_t begin = 4 * static_cast<std::size_t>(~at);
            for (std::size_t i = begin; i < std::min(begin + 4, patches_.size()); ++i)
                visit(patches_[i]);
            continue;
        }
        const Node& node = nodes_[static_cast<std::size_t>(at)];
        for (int lane = 0; lane < 4; ++lane) {
            const float margin = sigmas * node.thickest_m[lane];
            bool meets = true;
            for (int d = 0; d < D; ++d)
                meets = meets && node.low[d][lane] - margin <= high[d] &&
                        low[d] <= node.high[d][lane] + margin;
            if (meets) pending.push_back(node.child[lane]);
        }
    }
}

extern template class PatchTree<2>;
extern template class PatchTree<3>;

}  // namespace hgmm
