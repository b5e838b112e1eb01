#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "hgmm/hierarchy.h"
#include "hgmm/mixture.h"
#include "map/component_store.h"

namespace hgmm {

/// The upper levels of a map, kept up to date block by block.
///
/// Each block aims at params.levelRatio of the components of the level below it, merged
/// as in Algorithm 1, lines 6-16, with rising lambda_d.
///
/// Blocks are the leaves of an octree that is split wherever more than kMaxMembers
/// components lie, so they are small where detail is and large elsewhere. Components are
/// merged (Algorithm 1, lines 6-16) within their block only: a level depends on the base
/// block by block, and only the blocks that a scan touched are generated anew. The tree
/// depends on the base alone, not on how it came about, so the result is that of generating
/// all blocks.
class LevelBlocks {
 public:
    static constexpr std::size_t kMaxMembers = 512;

    /// Follows the base.
    void apply(const Changes& changes);

    /// Levels 1 .. params.levels - 1 at [0 ..]; regenerates blocks that changed since the
    /// last call.
    const std::vector<Mixture<3>>& levels(const Mixture<3>& base,
                                          const HierarchyParams& params);

    /// Component of level `level` >= 1 that holds each component of the base, as of the
    /// last call of levels().
    const std::vector<std::uint32_t>& parentOf(std::size_t level) const {
        return parentOf_[level - 1];
    }

    /// Blocks that the last call of levels() generated anew.
    std::size_t lastRegenerated() const { return lastRegenerated_; }

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    using Key =
        std::pair<int, std::uint64_t>;  ///< depth in the octree, Morton code of the node
    struct Block {
        std::vector<std::uint32_t> members;  ///< base components, rising
        std::vector<Mixture<3>> levels;      ///< from level 1 up
        /// Per level, for each member: its component there.
        std::vector<std::vector<std::uint32_t>> parentOf;
    };
    struct Placed {
        std::uint64_t morton;
        std::uint32_t component;
    };

    void split(const Placed* first, const Placed* last, int depth, const Mixture<3>& base,
               const HierarchyParams& params, std::map<Key, Block>& fresh);
    void assemble(std::size_t baseSize, std::size_t upperLevels);
    bool isCurrent(const Block& block, const std::vector<std::uint32_t>& members) const;

    std::map<Key, Block> blocks_;
    std::vector<bool> changed_;  ///< per base component
    std::vector<Mixture<3>> levels_;
    std::vector<std::vector<std::uint32_t>> parentOf_;
    bool stale_ = true;
    std::size_t lastRegenerated_ = 0;
};

}  // namespace hgmm
