#include "channel_scales.h"

#include <algorithm>
#include <cmath>

namespace hgmm::importer {
namespace {

constexpr float kEightBits = 255;

void include(float value, float& largest) {
    if (std::isfinite(value)) largest = std::max(largest, value);
}

float scaleOf(float largest) {
    for (const float scale : {1.F, kEightBits, 65535.F})
        if (largest <= scale) return scale;
    return largest;
}

}  // namespace

void LargestChannels::add(const RecordedCloud& cloud) {
    hasIntensity_ = hasIntensity_ || cloud.hasIntensity;
    if (cloud.bytesOfIntensity) include(kEightBits, intensity_);
    if (cloud.bytesOfColor) include(kEightBits, color_);
    for (const auto& point : cloud.points) {
        if (cloud.hasIntensity) include(point.intensity, intensity_);
        if (cloud.hasColor)
            for (const float value : point.color) include(value, color_);
    }
}

ChannelScales LargestChannels::scales() const {
    return {scaleOf(intensity_), scaleOf(color_)};
}

}  // namespace hgmm::importer
