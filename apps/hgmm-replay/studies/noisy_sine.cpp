#include "studies/noisy_sine.h"

#include <cmath>

namespace replay {

double NoisySine::mean(double x) {
    return std::sin(3.0 * x);
}

double NoisySine::uniform() {
    return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
}

hgmm::Mixture<2> NoisySine::draw(std::size_t n) {
    constexpr double kTwoPi = 6.283185307179586477;
    hgmm::Mixture<2> samples;
    hgmm::Gaussian<2> sample;
    sample.support = 1.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = kLow + (kHigh - kLow) * uniform();
        // Box and Muller: the same numbers with every standard library.
        const double radius = std::sqrt(-2.0 * std::log(uniform()));
        const double normal = radius * std::cos(kTwoPi * uniform());
        sample.mean << x, mean(x) + kNoiseStd * normal;
        samples.pushBack(sample);
    }
    return samples;
}

}  // namespace replay
