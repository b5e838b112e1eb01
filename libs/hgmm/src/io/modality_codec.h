#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "modality/channel_mixture.h"

namespace hgmm {

/// Components of a group of J modalities as they are saved: 17 + 6 J bytes each, for J = 3
/// less than half of what J separate models would take, and 12 for each block of 16 m that
/// holds any.
///
/// | what | bits | error, at most |
/// | --- | --- | --- |
/// | place and support | 136 | see encodeSurfaces |
/// | mean of the channel, in the range of all means | 16 | 1/130000 of the range |
/// | change of the channel along each whitened axis, in the range of all | 3 x 8 | 0.4 % |
/// | residual sigma, logarithmic | 8 | 6 % |
///
/// Decoding and encoding again gives the same bytes.
void encodeChannels(const ChannelMixture& mixture, std::vector<std::uint8_t>& bytes);

/// Replaces `mixture`, whose number of channels is that of the data; returns the bytes
/// read. Throws std::out_of_range if the data ends too early.
std::size_t decodeChannels(const std::uint8_t* data, std::size_t size,
                           ChannelMixture& mixture);

}  // namespace hgmm
