#pragma once
#include <cstddef>
#include <cstdint>

namespace hgmm::fuzz {

/// What each harness defines: does something with the bytes. Throws (Violation, or whatever
/// its code lets out) if a promise is broken; input that is refused, as it may be, returns.
void runOne(const std::uint8_t* data, std::size_t size);

}  // namespace hgmm::fuzz
