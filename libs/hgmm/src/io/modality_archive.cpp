#include "io/modality_archive.h"

#include <algorithm>

#include "io/exact_codec.h"
#include "io/modality_codec.h"

namespace hgmm {

namespace {

// Layout: names; u8 encoding; u32 groups, then each: names, u64 bytes and encodeChannels if
// compact, else its places as exact mixture and f32 arrays for each channel (mean,
// residual, slope). Names are u32 count, then each u8 length and characters.

void putNames(Writer& out, const std::vector<std::string>& names) {
    out.put(static_cast<std::uint32_t>(names.size()));
    for (const std::string& name : names) {
        out.put(static_cast<std::uint8_t>(name.size()));
        out.put(name.data(), name.size());
    }
}

std::vector<std::string> getNames(Reader& in) {
    const auto count = in.get<std::uint32_t>();
    if (count > kMaxModalities) throw FormatError("saved map: too many modalities");
    std::vector<std::string> names(count);
    for (std::string& name : names) {
        name.resize(in.get<std::uint8_t>());
        in.get(name.data(), name.size());
    }
    return names;
}

void putExact(Writer& out, const ChannelMixture& mixture) {
    putMixture(out, mixture.places());
    for (int c = 0; c < mixture.channels(); ++c)
        mixture.forEachArray(c, [&](const std::vector<float>& array) {
            out.put(array.data(), array.size());
        });
}

void getExact(Reader& in, ChannelMixture& mixture) {
    mixture.assignPlaces(getMixture<3>(in));
    for (int c = 0; c < mixture.channels(); ++c)
        mixture.forEachArray(
            c, [&](std::vector<float>& array) { in.get(array.data(), array.size()); });
}

ModalityGroup getGroup(Reader& in, Encoding encoding,
                       const std::vector<std::string>& modalities) {
    const std::vector<std::string> names = getNames(in);
    if (names.empty()) throw FormatError("saved map: a group of no modalities");
    for (const std::string& name : names)
        if (std::find(modalities.begin(), modalities.end(), name) == modalities.end())
            throw FormatError("saved map: it does not model '" + name + "' that it holds");
    ChannelMixture mixture(static_cast<int>(names.size()));
    if (encoding == Encoding::exact)
        getExact(in, mixture);
    else
        getSection(in, [&](const std::uint8_t* data, std::size_t size) {
            return decodeChannels(data, size, mixture);
        });
    try {
        mixture.check();
    } catch (const std::logic_error& e) {
        throw FormatError(std::string("saved map: ") + e.what());
    }
    return {names, std::move(mixture)};
}

}  // namespace

void putModalities(Writer& out, const MapParams& params, const Modalities& modalities,
                   Encoding encoding) {
    putNames(out, params.modalities);
    out.put(static_cast<std::uint8_t>(encoding));
    out.put(static_cast<std::uint32_t>(modalities.groups().size()));
    for (const ModalityGroup& group : modalities.groups()) {
        putNames(out, group.names());
        if (encoding == Encoding::exact)
            putExact(out, group.mixture());
        else
            putSection(out, [&](auto& bytes) { encodeChannels(group.mixture(), bytes); });
    }
}

Modalities getModalities(Reader& in, MapParams& params) {
    params.modalities = getNames(in);
    try {
        params.validate();
    } catch (const std::invalid_argument& e) {
        throw FormatError(std::string("saved map: ") + e.what());
    }
    const auto encoding = in.get<std::uint8_t>();
    if (encoding > static_cast<std::uint8_t>(Encoding::compact))
        throw FormatError("saved map: unknown encoding " + std::to_string(encoding));
    Modalities modalities;
    const auto groups = in.get<std::uint32_t>();
    if (groups > params.modalities.size()) throw FormatError("saved map: too many groups");
    for (std::uint32_t g = 0; g < groups; ++g) {
        ModalityGroup group = getGroup(in, Encoding{encoding}, params.modalities);
        for (const std::string& name : group.names())
            if (modalities.find(name) != nullptr)
                throw FormatError("saved map: modality '" + name + "' is there twice");
        modalities.add(std::move(group));
    }
    modalities.configure(params);
    return modalities;
}

}  // namespace hgmm
