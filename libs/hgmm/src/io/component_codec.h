#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/view_directions.h"

namespace hgmm {

/// The components of a mixture sorted by block, else in their order.
template <int D>
std::vector<std::uint32_t> blockOrder(const Mixture<D>& mixture);

/// Components as they are saved: 20 bytes for a surface component with its view, 23 bytes
/// for a free-space component, and 16 for each block of 16 m that holds any.
///
/// | what | bits | error, at most |
/// | --- | --- | --- |
/// | mean, in its block | 3 x 16 | 0.13 mm |
/// | Cholesky factor of the covariance, diagonal, logarithmic | 3 x 8 | 2.8 % |
/// | its other entries, per diagonal entry of their row | 3 x 16 | 1.6 % of that entry |
/// | support, logarithmic | 16 | 0.03 % |
/// | view direction (octahedron) | 2 x 8 | 0.9 deg |
/// | range, mean of W, residual sigma of W, logarithmic | 8 each | 2.5 % |
/// | slope of W | 3 x 8 | 0.005 |
///
/// Decoding and encoding again gives the same bytes (within 2 km of the origin). Components
/// more than some hundred times longer than thick come back a little thicker. Components
/// come back in `order`, a permutation; each run of it within one block costs a head.
void encodeSurfaces(const Mixture<3>& mixture, const ViewDirections& views,
                    const std::vector<std::uint32_t>& order,
                    std::vector<std::uint8_t>& out);
/// @param octaves one per component, in [-20, 20]
void encodeFree(const Mixture<4>& mixture, const std::vector<int>& octaves,
                const std::vector<std::uint32_t>& order, std::vector<std::uint8_t>& out);

/// Append to the mixtures what encode... wrote; return the bytes read. Throw
/// std::out_of_range if the data ends too early.
std::size_t decodeSurfaces(const std::uint8_t* data, std::size_t size, Mixture<3>& mixture,
                           ViewDirections& views);
std::size_t decodeFree(const std::uint8_t* data, std::size_t size, Mixture<4>& mixture,
                       std::vector<int>& octaves);

}  // namespace hgmm
