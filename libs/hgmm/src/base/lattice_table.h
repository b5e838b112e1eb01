#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/lattice.h"

namespace hgmm {

/// Values by lattice cell, in one open-addressing table: copied as a block of memory, and
/// without an allocation for each cell, because maps in particle filters are copied often.
template <typename Value>
class LatticeTable {
 public:
    std::size_t size() const { return size_; }

    /// Makes room for n cells in all.
    void reserve(std::size_t n) {
        if (4 * n > 3 * slots_.size()) rehash(4 * n / 3 + n / 2 + 16);
    }

    /// The value of a cell, nullptr if it has none. Holds until the next change.
    const Value* find(const LatticeCell& cell) const {
        if (slots_.empty()) return nullptr;
        const Slot& slot = slots_[place(cell)];
        return slot.used() ? &slot.value : nullptr;
    }

    /// The value of a cell, `initial` if it had none, and whether that was so.
    std::pair<Value*, bool> tryEmplace(const LatticeCell& cell, const Value& initial) {
        reserve(size_ + 1);
        Slot& slot = slots_[place(cell)];
        const bool isNew = !slot.used();
        if (isNew) {
            slot.cell = cell;
            slot.value = initial;
            ++size_;
        }
        return {&slot.value, isNew};
    }

    /// Calls visit(cell, value) for each cell that has one, in no order.
    template <typename Visitor>
    void forEach(Visitor&& visit) const {
        for (const Slot& slot : slots_)
            if (slot.used()) visit(slot.cell, slot.value);
    }

    /// Removes the value of a cell, if there is one.
    void erase(const LatticeCell& cell) {
        if (slots_.empty()) return;
        std::size_t hole = place(cell);
        if (!slots_[hole].used()) return;
        // Those behind it move up, unless their own place is behind the hole.
        for (std::size_t s = next(hole); slots_[s].used(); s = next(s)) {
            const std::size_t home = homeOf(slots_[s].cell);
            const bool stays =
                hole <= s ? hole < home && home <= s : hole < home || home <= s;
            if (stays) continue;
            slots_[hole] = slots_[s];
            hole = s;
        }
        slots_[hole] = Slot{};
        --size_;
    }

    std::size_t liveBytes() const { return slots_.capacity() * sizeof(Slot); }

 private:
    static constexpr int kUnused = std::numeric_limits<int>::min();
    struct Slot {
        LatticeCell cell{kUnused, 0, 0, 0};
        Value value{};
        bool used() const { return cell.octave != kUnused; }
    };

    std::size_t next(std::size_t s) const { return s + 1 == slots_.size() ? 0 : s + 1; }
    std::size_t homeOf(const LatticeCell& cell) const {
        const std::uint64_t hash = LatticeCellHash()(cell);
        return static_cast<std::size_t>(
            std::uint64_t{std::uint32_t(hash)} * slots_.size() >> 32U);
    }
    /// Where a cell is, or would be entered.
    std::size_t place(const LatticeCell& cell) const {
        std::size_t s = homeOf(cell);
        while (slots_[s].used() && !(slots_[s].cell == cell)) s = next(s);
        return s;
    }
    void rehash(std::size_t slots) {
        std::vector<Slot> old(slots);
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.used()) slots_[place(slot.cell)] = slot;
    }

    std::vector<Slot> slots_;  ///< at most three of four used
    std::size_t size_ = 0;
};

}  // namespace hgmm
