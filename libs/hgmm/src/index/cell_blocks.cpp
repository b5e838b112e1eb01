#include "index/cell_blocks.h"

namespace hgmm {

const CellBlocks::Group CellBlocks::kNoBlocks{};

CellBlocks::Group& CellBlocks::groupToMark(const LatticeCell& group) {
    return *groups_.tryEmplace(group, Group{}).first;
}

bool CellBlocks::markNew(Group& group, unsigned place, Word cells) {
    const Word bit = Word{1} << place;
    const bool isNew = (group.present & bit) == 0;
    const Word before = wordIn(group, place), after = before | cells;
    const unsigned rank = rankOf(group, place);
    if (after == kAllCells) {
        if (!isNew) words_.erase(group.words, rank);
        group.full |= bit;
    } else if (isNew) {
        words_.insert(group.words, rank, after);
    } else {
        words_.data(group.words)[rank] = after;
    }
    group.present |= bit;
    size_ += isNew ? 1 : 0;
    return isNew;
}

void CellBlocks::unmark(const LatticeCell& block, Word cells) {
    const Group* const found = groups_.find(blockOf(block));
    if (found == nullptr) return;
    const unsigned place = placeOf(block);
    const Word bit = Word{1} << place, before = wordIn(*found, place),
               after = before & ~cells;
    if (after == before) return;
    Group& group = *groups_.tryEmplace(blockOf(block), Group{}).first;
    const unsigned rank = rankOf(group, place);
    if (before == kAllCells) {
        group.full &= ~bit;
        if (after != 0) words_.insert(group.words, rank, after);
    } else if (after != 0) {
        words_.data(group.words)[rank] = after;
    } else {
        words_.erase(group.words, rank);
    }
    if (after != 0) return;
    --size_;
    group.present &= ~bit;
    if (group.present == 0) groups_.erase(blockOf(block));
}

}  // namespace hgmm
