#include "index/body_index.h"

#include <algorithm>
#include <stdexcept>

namespace hgmm {

namespace {

/// Whether a table is to grow before it holds so many.
bool isFull(std::size_t used, std::size_t slots) {
    return 4 * used > 3 * slots;
}

}  // namespace

void BodyIndex::reserve(std::size_t n) {
    // As maps go, a box touches some five cells that no other one has touched.
    constexpr std::size_t cellsPerBox = 5;
    std::size_t slots = 256;
    while (isFull(cellsPerBox * n, slots)) slots *= 2;
    if (slots > slots_.size()) growTable(slots);
    placements_.reserve(n);
}

void BodyIndex::growTable(std::size_t slots) {
    std::vector<Slot> old(slots);
    old.swap(slots_);
    const std::size_t mask = slots_.size() - 1;
    for (const Slot& slot : old) {
        if (!slot.used()) continue;
        std::size_t s = hash(slot.key) & mask;
        while (slots_[s].used()) s = (s + 1) & mask;
        slots_[s] = slot;
    }
}

BodyIndex::Slot& BodyIndex::findOrAdd(std::uint64_t key) {
    if (isFull(usedSlots_ + 1, slots_.size())) growTable(2 * slots_.size());
    const std::size_t mask = slots_.size() - 1;
    std::size_t s = hash(key) & mask;
    while (slots_[s].used() && slots_[s].key != key) s = (s + 1) & mask;
    Slot& slot = slots_[s];
    if (!slot.used()) {
        slot.key = key;
        ++usedSlots_;
    }
    return slot;
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
    Slot& slot = findOrAdd(key);
    if (slot.count == 1U << slot.capacityLog2) {
        const std::uint32_t larger = allocate(slot.capacityLog2 + 1);
        std::copy_n(membersOf(slot), slot.count, pool_.begin() + larger);
        if (slot.capacityLog2 > 0) free_[slot.capacityLog2].push_back(slot.begin);
        slot.begin = larger;
        ++slot.capacityLog2;
    }
    std::uint32_t *const first = membersOf(slot), *const last = first + slot.count;
    std::uint32_t* const place = std::upper_bound(first, last, i);
    std::copy_backward(place, last, last + 1);
    *place = i;
    ++slot.count;
}

void BodyIndex::remove(std::uint64_t key, std::uint32_t i) {
    const Slot* found = find(key);
    if (found == nullptr) return;
    Slot& slot = slots_[static_cast<std::size_t>(found - slots_.data())];
    std::uint32_t *const first = membersOf(slot), *const last = first + slot.count;
    std::uint32_t* const member = std::find(first, last, i);
    if (member == last) return;
    std::copy(member + 1, last, member);
    --slot.count;
}

void BodyIndex::count(int octave, int boxes) {
    std::uint32_t& inOctave = boxesInOctave_[octave - kMinOctave];
    const bool wasUsed = inOctave > 0;
    inOctave += static_cast<std::uint32_t>(boxes);
    if (wasUsed == (inOctave > 0)) return;
    usedOctaveCount_ = 0;
    for (int o = 0; o < kOctaves; ++o)
        if (boxesInOctave_[o] > 0)
            usedOctaves_[usedOctaveCount_++] = static_cast<std::int8_t>(o + kMinOctave);
}

void BodyIndex::place(std::uint32_t i, const Placement& placement) {
    if (i > size()) throw std::out_of_range("BodyIndex::update: a gap before it");
    if (slots_.empty()) growTable(256);
    if (i == size())
        placements_.emplace_back();
    else
        count(placements_[i].octave, -1);
    placements_[i] = placement;
    count(placement.octave, 1);
}

void BodyIndex::truncate(std::size_t n) {
    for (; size() > n; placements_.pop_back()) {
        const Placement gone = placements_.back();
        const auto i = static_cast<std::uint32_t>(size() - 1);
        forEachCell(gone, [&](auto... cell) { remove(keyOf(gone.octave, cell...), i); });
        count(gone.octave, -1);
    }
}

std::size_t BodyIndex::liveBytes() const {
    std::size_t bytes = placements_.capacity() * sizeof(Placement) +
                        slots_.capacity() * sizeof(Slot) +
                        pool_.capacity() * sizeof(std::uint32_t);
    for (const auto& unused : free_) bytes += unused.capacity() * sizeof(std::uint32_t);
    return bytes;
}

}  // namespace hgmm
