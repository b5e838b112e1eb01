#pragma once
#include <stdexcept>
#include <string>

namespace hgmm {

/// Throws std::invalid_argument "name = value: must be in [low, high]" unless it is; NaN
/// never is.
inline void requireInRange(const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) +
                                ": must be in [" + std::to_string(low) + ", " +
                                std::to_string(high) + "]");
}

}  // namespace hgmm
