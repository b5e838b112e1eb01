#include "index/body_index.h"

#include <algorithm>
#include <stdexcept>

namespace hgmm {

void BodyIndex::reserve(std::size_t n) {
    // As maps go, a box touches some five cells that no other one has touched.
    constexpr std::size_t cellsPerBox = 5;
    table_.reserve(cellsPerBox * n);
    placements_.reserve(n);
}

std::uint32_t BodyIndex::allocate(unsigned capacityLog2) {
    std::vector<std::uint32_t>& unused = free_[capacityLog2];
    if (!unused.empty()) {
        const std::uint32_t begin = unused.back();
        unused.pop_back();
        return begin;
    }
    const auto begin = static_cast<std::uint32_t>(pool_.size());
    const std::size_t size = pool_.size() + (std::size_t{1} << capacityLog2);
    if (size > pool_.capacity()) pool_.reserve(size + size / 4);
    pool_.resize(size);
    return begin;
}

void BodyIndex::add(std::uint64_t key, std::uint32_t i) {
    Members& members = *table_.tryEmplace(key, Members()).first;
    if (members.count == 1U << members.capacityLog2) {
        const std::uint32_t larger = allocate(members.capacityLog2 + 1);
        std::copy_n(membersOf(members), members.count, pool_.begin() + larger);
        if (members.capacityLog2 > 0) free_[members.capacityLog2].push_back(members.begin);
        members.begin = larger;
        ++members.capacityLog2;
    }
    std::uint32_t *const first = membersOf(members), *const last = first + members.count;
    std::uint32_t* const place = std::upper_bound(first, last, i);
    std::copy_backward(place, last, last + 1);
    *place = i;
    ++members.count;
}

void BodyIndex::remove(std::uint64_t key, std::uint32_t i) {
    Members* const members = table_.find(key);
    if (members == nullptr) return;
    std::uint32_t *const first = membersOf(*members), *const last = first + members->count;
    std::uint32_t* const member = std::find(first, last, i);
    if (member == last) return;
    std::copy(member + 1, last, member);
    --members->count;
}

void BodyIndex::place(std::uint32_t i, const Placement& placement) {
    if (i > size()) throw std::out_of_range("BodyIndex::update: a gap before it");
    if (i == size())
        placements_.emplace_back();
    else
        octaves_.remove(placements_[i].octave);
    placements_[i] = placement;
    octaves_.add(placement.octave);
}

void BodyIndex::truncate(std::size_t n) {
    for (; size() > n; placements_.pop_back()) {
        const Placement gone = placements_.back();
        const auto i = static_cast<std::uint32_t>(size() - 1);
        forEachCell(gone, [&](const Cell& cell) {
            remove(PackedCellKeys::of(gone.octave, cell), i);
        });
        octaves_.remove(gone.octave);
    }
}

std::size_t BodyIndex::liveBytes() const {
    std::size_t bytes = placements_.capacity() * sizeof(Placement) + table_.liveBytes() +
                        pool_.capacity() * sizeof(std::uint32_t);
    for (const auto& unused : free_) bytes += unused.capacity() * sizeof(std::uint32_t);
    return bytes;
}

}  // namespace hgmm
