#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "hgmm/params.h"
#include "hgmm/scan.h"

namespace hgmm {

/// Leaves of a scan with the moments of place and channels: what filterScan makes of points
/// alone. Sums (ChannelSums) are about the sensor's origin.
class ChannelSamples {
 public:
    explicit ChannelSamples(int channels) : channels_(channels) {}

    int channels() const { return channels_; }
    std::size_t size() const { return mean_[0].size(); }
    const double* sums(std::size_t i) const { return sums_.data() + i * stride(); }
    /// Centroids, sensor frame [m].
    const std::array<std::vector<float>, 3>& mean() const { return mean_; }

    /// The same with these channels only, in this order.
    ChannelSamples withChannels(const std::vector<int>& channels) const;

    void reserve(std::size_t n);
    /// @param sums of one leaf, about its anchor
    void pushBack(const double* sums, const std::array<float, 3>& anchor,
                  const FilterParams& filter, double channelNoise);

 private:
    std::size_t stride() const;

    int channels_;
    std::vector<double> sums_;
    std::array<std::vector<float>, 3> mean_;
};

/// Whether a value counts as measured: finite and not beyond 1e6.
inline bool isMeasured(float value) {
    return (value >= -1e6F) & (value <= 1e6F);
}

/// One sample per leaf that holds points where the first of `channels`, and so all, were
/// measured.
/// @param channels 1 to kMaxModalities
ChannelSamples filterChannels(const Scan& scan, const std::vector<const Channel*>& channels,
                              const FilterParams& filter, const ModalityParams& params);

}  // namespace hgmm
