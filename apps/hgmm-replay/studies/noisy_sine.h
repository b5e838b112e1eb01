#pragma once
#include <cstddef>
#include <cstdint>
#include <random>

#include "hgmm/mixture.h"

namespace replay {

/// y = sin(3 x) + N(0, kNoiseStd^2), x uniform in [kLow, kHigh): thesis eq. (4.19).
class NoisySine {
 public:
    static constexpr double kLow = -2.0, kHigh = 2.0;
    static constexpr double kNoiseStd = 0.05;

    explicit NoisySine(std::uint64_t seed) : engine_(seed) {}

    /// The next n points (x, y), as samples of support 1 without extent.
    hgmm::Mixture<2> draw(std::size_t n);
    static double mean(double x);

 private:
    double uniform();  ///< in (0, 1)

    std::mt19937_64 engine_;
};

}  // namespace replay
