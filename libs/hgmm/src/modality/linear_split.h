#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "hgmm/params.h"
#include "modality/channel_mixture.h"
#include "modality/channel_samples.h"

namespace hgmm {

/// A part of a scan over which each channel is taken to be linear in x.
struct LinearRegion {
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

    std::vector<std::uint32_t> samples;    ///< rising
    std::uint32_t component = kNone;       ///< of the map, that it stands for
    std::optional<ChannelGaussian> prior;  ///< what the map knew of it, sensor frame
};

/// Splits regions in two where that explains most of what linear functions of x leave of
/// the channels, until they explain all but params.modalityUnexplained of the channels'
/// variance within the scan, or no split is worth its parameters by Bayes' information
/// criterion. This is the initialisation that thesis 5.3.3 misses: an edge of colour inside
/// a surface becomes an edge between components.
///
/// A region is cut across one of its two longest principal axes. Its prior is cut along:
/// both parts together keep its moments. The first part stands for the component, the other
/// for a new one.
std::vector<LinearRegion> splitWhereNotLinear(const ChannelSamples& samples,
                                              std::vector<LinearRegion> regions,
                                              const ModalityParams& params);

/// The parts of a component on both sides of the plane direction^T x = offset, of which
/// `below` is the first: moments of the truncated Gaussian, so that together they have
/// those of the whole. A part with less than a hundredth of the support is left out, and
/// the other is the whole.
struct CutComponent {
    std::optional<ChannelGaussian> below, above;
};
CutComponent cut(const ChannelGaussian& component, int channels,
                 const Eigen::Vector3d& direction, double offset);

}  // namespace hgmm
