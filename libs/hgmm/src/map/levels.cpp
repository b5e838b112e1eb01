#include "map/levels.h"

#include <algorithm>
#include <cmath>

namespace hgmm {

namespace {

constexpr int kMaxDepth = 21;  // bits an axis in a 64-bit Morton code
constexpr double kFinestCell_m =
    1.0 / 128;  // so the tree spans 16 km; beyond, it ends in one block

/// Spreads 21 bits so that two zeros follow each.
std::uint64_t spread(std::uint64_t v) {
    v &= 0x1FFFFF;
    v = (v | v << 32U) & 0x1F00000000FFFFULL;
    v = (v | v << 16U) & 0x1F0000FF0000FFULL;
    v = (v | v << 8U) & 0x100F00F00F00F00FULL;
    v = (v | v << 4U) & 0x10C30C30C30C30C3ULL;
    v = (v | v << 2U) & 0x1249249249249249ULL;
    return v;
}

std::uint64_t mortonOf(const Mixture<3>& base, std::uint32_t i) {
    std::uint64_t code = 0;
    for (int d = 0; d < 3; ++d) {
        const double cell =
            std::floor(base.mean[d][i] / kFinestCell_m) + (1 << (kMaxDepth - 1));
        const double limit = (1 << kMaxDepth) - 1;
        code |= spread(static_cast<std::uint64_t>(std::clamp(cell, 0.0, limit)))
                << unsigned(d);
    }
    return code;
}

/// The upper levels of one block, and for each the component that holds each member.
void generate(const std::vector<std::uint32_t>& members, const Mixture<3>& base,
              const HierarchyParams& params, std::vector<Mixture<3>>& levels,
              std::vector<std::vector<std::uint32_t>>& parentOf) {
    Mixture<3> level;
    std::vector<std::uint32_t> parents, next;
    for (const std::uint32_t i : members) {
        parents.push_back(static_cast<std::uint32_t>(level.size()));
        level.pushBack(base[i]);
    }
    for (int l = 1; l < params.levels; ++l) {
        const auto size =
            static_cast<std::size_t>(params.levelRatio * double(level.size()));
        level = mergeToSize(level, std::max<std::size_t>(size, 1), params, &next);
        for (std::uint32_t& h : parents) h = next[h];
        levels.push_back(level);
        parentOf.push_back(parents);
    }
}

std::size_t bytesOf(const Mixture<3>& m) {
    return m.support.capacity() * sizeof(float) * (1 + 3 + Mixture<3>::packed);
}

}  // namespace

void LevelBlocks::apply(const Changes& changes) {
    changed_.resize(changes.size);
    for (const std::uint32_t i : changes.updated) changed_[i] = true;
    stale_ = true;
}

bool LevelBlocks::isCurrent(const Block& block,
                            const std::vector<std::uint32_t>& members) const {
    return block.members == members &&
           std::none_of(members.begin(), members.end(),
                        [&](std::uint32_t i) { return changed_[i]; });
}

void LevelBlocks::split(const Placed* first, const Placed* last, int depth,
                        const Mixture<3>& base, const HierarchyParams& params,
                        std::map<Key, Block>& fresh) {
    if (first == last) return;
    const int shift = 3 * (kMaxDepth - depth);
    if (std::size_t(last - first) > kMaxMembers && depth < kMaxDepth) {
        while (first != last) {
            const std::uint64_t child = first->morton >> unsigned(shift - 3);
            const Placed* end = std::find_if(first, last, [&](const Placed& p) {
                return p.morton >> unsigned(shift - 3) != child;
            });
            split(first, end, depth + 1, base, params, fresh);
            first = end;
        }
        return;
    }
    Block block;
    for (const Placed* p = first; p != last; ++p) block.members.push_back(p->component);
    std::sort(block.members.begin(), block.members.end());
    const Key key{depth, depth == 0 ? 0 : first->morton >> unsigned(shift)};
    const auto old = blocks_.find(key);
    if (old != blocks_.end() && isCurrent(old->second, block.members)) {
        fresh.emplace(key, std::move(old->second));
        return;
    }
    generate(block.members, base, params, block.levels, block.parentOf);
    fresh.emplace(key, std::move(block));
    ++lastRegenerated_;
}

const std::vector<Mixture<3>>& LevelBlocks::levels(const Mixture<3>& base,
                                                   const HierarchyParams& params) {
    if (!stale_) return levels_;
    std::vector<Placed> placed;
    placed.reserve(base.size());
    for (std::uint32_t i = 0; i < base.size(); ++i)
        placed.push_back({mortonOf(base, i), i});
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
        return a.morton != b.morton ? a.morton < b.morton : a.component < b.component;
    });

    lastRegenerated_ = 0;
    std::map<Key, Block> fresh;
    split(placed.data(), placed.data() + placed.size(), 0, base, params, fresh);
    blocks_ = std::move(fresh);

    assemble(base.size(), static_cast<std::size_t>(params.levels - 1));
    changed_.assign(base.size(), false);
    stale_ = false;
    return levels_;
}

void LevelBlocks::assemble(std::size_t baseSize, std::size_t upperLevels) {
    levels_.assign(upperLevels, {});
    parentOf_.assign(upperLevels, std::vector<std::uint32_t>(baseSize));
    for (const auto& entry : blocks_) {
        const Block& block = entry.second;
        for (std::size_t l = 0; l < upperLevels; ++l) {
            const auto first = static_cast<std::uint32_t>(levels_[l].size());
            for (std::size_t m = 0; m < block.members.size(); ++m)
                parentOf_[l][block.members[m]] = first + block.parentOf[l][m];
            levels_[l].append(block.levels[l]);
        }
    }
}

std::size_t LevelBlocks::liveBytes() const {
    // A node of a red-black tree carries three pointers, a colour and the allocator's word.
    constexpr std::size_t nodeBytes = 5 * sizeof(void*);
    std::size_t bytes = changed_.capacity() / 8;
    for (const Mixture<3>& level : levels_) bytes += bytesOf(level);
    for (const auto& entry : blocks_) {
        bytes += nodeBytes + sizeof(entry) +
                 entry.second.members.capacity() * sizeof(std::uint32_t);
        for (const Mixture<3>& level : entry.second.levels) bytes += bytesOf(level);
        for (const auto& parents : entry.second.parentOf)
            bytes += parents.capacity() * sizeof(std::uint32_t);
    }
    return bytes;
}

}  // namespace hgmm
