#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace hgmm {

/// Values by key, in one open-addressing table: copied as a block of memory, and without an
/// allocation for each key, because maps in particle filters are copied often.
///
/// Keys::unused() is a key that nobody has, Keys::hash(key) spreads the others over 32
/// bits.
template <typename Key, typename Value, typename Keys>
class HashTable {
 public:
    std::size_t size() const { return size_; }

    /// Makes room for n keys in all.
    void reserve(std::size_t n) {
        if (4 * n > 3 * slots_.size()) rehash(4 * n / 3 + n / 2 + 16);
    }

    /// The value of a key, nullptr if it has none. Holds until the next change.
    const Value* find(const Key& key) const {
        if (slots_.empty()) return nullptr;
        const Slot& slot = slots_[place(key)];
        return slot.used() ? &slot.value : nullptr;
    }

    Value* find(const Key& key) {
        return const_cast<Value*>(std::as_const(*this).find(key));
    }

    /// The value of a key, `initial` if it had none, and whether that was so.
    std::pair<Value*, bool> tryEmplace(const Key& key, const Value& initial) {
        reserve(size_ + 1);
        Slot& slot = slots_[place(key)];
        const bool isNew = !slot.used();
        if (isNew) {
            slot.key = key;
            slot.value = initial;
            ++size_;
        }
        return {&slot.value, isNew};
    }

    /// Calls visit(key, value) for each key that has one, in no order.
    template <typename Visitor>
    void forEach(Visitor&& visit) const {
        for (const Slot& slot : slots_)
            if (slot.used()) visit(slot.key, slot.value);
    }

    /// Removes the value of a key, if there is one.
    void erase(const Key& key) {
        if (slots_.empty()) return;
        std::size_t hole = place(key);
        if (!slots_[hole].used()) return;
        // Those behind it move up, unless their own place is behind the hole.
        for (std::size_t s = next(hole); slots_[s].used(); s = next(s)) {
            const std::size_t home = homeOf(slots_[s].key);
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
    struct Slot {
        Key key = Keys::unused();
        Value value{};
        bool used() const { return !(key == Keys::unused()); }
    };

    std::size_t next(std::size_t s) const { return s + 1 == slots_.size() ? 0 : s + 1; }
    std::size_t homeOf(const Key& key) const {
        return static_cast<std::size_t>(
            std::uint64_t{std::uint32_t(Keys::hash(key))} * slots_.size() >> 32U);
    }
    /// Where a key is, or would be entered.
    std::size_t place(const Key& key) const {
        std::size_t s = homeOf(key);
        while (slots_[s].used() && !(slots_[s].key == key)) s = next(s);
        return s;
    }
    void rehash(std::size_t slots) {
        std::vector<Slot> old(slots);
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.used()) slots_[place(slot.key)] = slot;
    }

    std::vector<Slot> slots_;  ///< at most three of four used
    std::size_t size_ = 0;
};

}  // namespace hgmm
