#pragma once
#include "recorded_cloud.h"

namespace hgmm::importer {

/// What the channels of a recording are divided by to be in [0, 1]: one number for all of
/// its scans, so that the same surface has the same value in all of them.
struct ChannelScales {
    float intensity = 1;
    float color = 255;
};

/// The largest values of a recording's channels, which tell their scales.
class LargestChannels {
 public:
    void add(const RecordedCloud& cloud);
    bool hasIntensity() const { return hasIntensity_; }
    /// 1, 255 or 65535, the first that no value exceeds, but no less than the widths of the
    /// fields say; the largest value if it exceeds all of them.
    ChannelScales scales() const;

 private:
    bool hasIntensity_ = false;
    float intensity_ = 0, color_ = 0;
};

}  // namespace hgmm::importer
