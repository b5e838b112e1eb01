#pragma once
#include <cstdint>
#include <stdexcept>

#include "hgmm/map.h"

/// What holds for every map, whatever went into it.
namespace hgmm::fuzz {

/// A promise that is broken.
class Violation : public std::logic_error {
 public:
    using std::logic_error::logic_error;
};

inline void require(bool holds, const char* promise) {
    if (!holds) throw Violation(promise);
}

/// Asks the map at points that the seed chooses, near its components and far from them.
/// Throws Violation unless probabilities are in [0, 1] and sum to one, all answers are
/// finite, and a copy, whose caches are fresh, gives the same ones, bit for bit.
void requireSoundAnswers(const Map& map, std::uint64_t seed);

/// Throws Violation unless all levels are mixtures (Mixture::check) within the bounds of
/// maps, a map that is saved exactly comes back equal, and one from a compact buffer saves
/// to that buffer.
void requireStableSaving(const Map& map);

}  // namespace hgmm::fuzz
