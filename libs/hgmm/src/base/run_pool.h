#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/growth.h"

namespace hgmm {

/// A list in a RunPool: empty at first, and the pool's alone to change.
struct PoolRun {
    std::uint32_t begin = 0;
    std::uint32_t count : 26;
    std::uint32_t size : 6;  ///< which room it has
    PoolRun() : count(0), size(0) {}
};

/// Many short lists in one array: copied as a block of memory, and without an allocation
/// for each. A list has room for a little more than it holds; what it leaves when it
/// moves to a larger place is used again.
template <typename Value>
class RunPool {
 public:
    const Value* data(const PoolRun& run) const { return values_.data() + run.begin; }
    Value* data(const PoolRun& run) { return values_.data() + run.begin; }

    /// Puts a value before place k <= run.count.
    void insert(PoolRun& run, std::uint32_t k, const Value& value) {
        if (run.count == roomOf(run.size)) enlarge(run);
        Value* const first = data(run);
        std::copy_backward(first + k, first + run.count, first + run.count + 1);
        first[k] = value;
        ++run.count;
    }
    /// Removes the value at place k < run.count.
    void erase(PoolRun& run, std::uint32_t k) {
        Value* const first = data(run);
        std::copy(first + k + 1, first + run.count, first + k);
        if (--run.count > 0) return;
        unused_[run.size].push_back(run.begin);
        run = PoolRun{};
    }

    std::size_t liveBytes() const {
        std::size_t bytes = values_.capacity() * sizeof(Value);
        for (const auto& begins : unused_)
            bytes += begins.capacity() * sizeof(std::uint32_t);
        return bytes;
    }

 private:
    /// 0 1 2 3 4 6 8 12 16 ...
    static constexpr std::uint32_t roomOf(std::uint32_t size) {
        return size < 4 ? size : (2U + (size & 1U)) << (size / 2 - 1);
    }
    void enlarge(PoolRun& run) {
        const std::uint32_t size = run.size + 1, room = roomOf(size);
        std::uint32_t begin = 0;
        if (!unused_[size].empty()) {
            begin = unused_[size].back();
            unused_[size].pop_back();
        } else {
            begin = static_cast<std::uint32_t>(values_.size());
            growTo(values_, values_.size() + room);
        }
        std::copy_n(values_.begin() + run.begin, run.count, values_.begin() + begin);
        if (run.size > 0) unused_[run.size].push_back(run.begin);
        run.begin = begin;
        run.size = size;
    }

    std::vector<Value> values_;
    std::array<std::vector<std::uint32_t>, 56> unused_;  ///< begins of runs, by size
};

}  // namespace hgmm
