#pragma once
#include <cstdint>
#include <limits>

#include "base/hash_table.h"
#include "base/lattice.h"

namespace hgmm {

struct LatticeCellKeys {
    static LatticeCell unused() { return {std::numeric_limits<int>::min(), 0, 0, 0}; }
    static std::uint64_t hash(const LatticeCell& cell) { return LatticeCellHash()(cell); }
};

/// Values by lattice cell.
template <typename Value>
using LatticeTable = HashTable<LatticeCell, Value, LatticeCellKeys>;

}  // namespace hgmm
