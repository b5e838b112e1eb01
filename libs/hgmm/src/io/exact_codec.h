#pragma once
#include <cstdint>
#include <vector>

#include "base/byte_stream.h"
#include "hgmm/map.h"
#include "hgmm/mixture.h"
#include "mixture/mixture_arrays.h"

/// Mixtures as they are saved bit for bit: u64 components, then f32 arrays (support, means,
/// packed covariances).
namespace hgmm {

template <int D>
void putMixture(Writer& out, const Mixture<D>& mixture) {
    out.put(static_cast<std::uint64_t>(mixture.size()));
    forEachArray(mixture,
                 [&](const std::vector<float>& a) { out.put(a.data(), a.size()); });
}

/// Throws FormatError if the data ends too early.
template <int D>
Mixture<D> getMixture(Reader& in) {
    constexpr std::size_t bytesPerComponent = sizeof(float) * (1 + D + Mixture<D>::packed);
    const auto n = in.get<std::uint64_t>();
    if (n > in.left() / bytesPerComponent)
        throw FormatError("saved map: it ends too early");
    Mixture<D> mixture;
    forEachArray(mixture, [&](std::vector<float>& array) {
        array.resize(n);
        in.get(array.data(), n);
    });
    return mixture;
}

/// A compact section: its length, then what `encode` appends.
template <typename Encode>
void putSection(Writer& out, Encode&& encode) {
    std::vector<std::uint8_t> section;
    encode(section);
    out.put(static_cast<std::uint64_t>(section.size()));
    out.put(section.data(), section.size());
}

/// @param decode returns the bytes read; throws FormatError if these are not all
template <typename Decode>
void getSection(Reader& in, Decode&& decode) {
    const auto bytes = in.get<std::uint64_t>();
    if (bytes > in.left()) throw FormatError("saved map: it ends too early");
    if (decode(in.here(), static_cast<std::size_t>(bytes)) != bytes)
        throw FormatError("saved map: bytes are left over in a section");
    in.skip(static_cast<std::size_t>(bytes));
}

}  // namespace hgmm
