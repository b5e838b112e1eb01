#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/byte_stream.h"
#include "hgmm/map.h"
#include "io/checksum.h"
#include "io/component_codec.h"
#include "io/coverage_codec.h"
#include "io/coverage_words.h"
#include "io/exact_codec.h"
#include "io/modality_archive.h"
#include "map/model.h"
#include "occupancy/coverage_guess.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "saved maps are little-endian");
static_assert(std::numeric_limits<float>::is_iec559 &&
                  std::numeric_limits<double>::is_iec559,
              "saved maps hold IEEE 754 numbers");

namespace hgmm {

namespace {

// Layout:
//   char[4] "HGMM", u32 version, u64 size of the whole buffer, u64 checksum of what
//   follows, u32 fields, then each: u8 length, name, f64 value   (MapParams), f64[3] origin
// version 1 goes on:
//   surfaces as exact mixture; there are no views and no free space
// version 2 goes on:
//   u8 encoding
//   exact: surfaces, four f32 arrays of views, free space with i8 octaves behind it, an
//   empty mixture (once free space of surfaces)
//   compact: u64 bytes, then encodeSurfaces; twice u64 bytes, then encodeFree, the second
//   empty
// version 3 goes on:
//   modalities (putModalities); maps that model none were written as version 2
// version 4 has, behind free space:
//   u64 bytes, then exact: writeCoverage (encodeCoverage is read, too), compact:
//   encodeCoverage
// and ends with modalities, whether it models any or not.
// version 5 has, behind coverage and alike, openings, then cells that were passed once, of
// which compact has none; maps without either are written as version 4
// An exact mixture is that of putMixture.
constexpr char kMagic[4] = {'H', 'G', 'M', 'M'};
constexpr std::uint32_t kVersion = 5, kWithoutModalities = 2, kWithCoverage = 4,
                        kWithOpenings = 5;
constexpr std::size_t kHeader = 24;

[[noreturn]] void refuse(const RetiredOption& option) {
    throw FormatError(std::string("saved map: ") + option.name + " = 1: " + option.reason);
}

void putParams(Writer& out, const MapParams& params) {
    std::uint32_t fields = 0;
    forEachNumber(params, [&](const OptionRow&, const auto&) { ++fields; });
    out.put(fields);
    forEachNumber(params, [&](const OptionRow& row, const auto& value) {
        const auto length = static_cast<std::uint8_t>(std::strlen(row.name));
        out.put(length);
        out.put(row.name, length);
        out.put(static_cast<double>(value));
    });
}

/// Fields are found by name, also by a former one: one that a file does not hold keeps its
/// default. Files hold every length, so that none follows resolution_m here.
MapParams getParams(Reader& in) {
    MapParams params;
    const auto fields = in.get<std::uint32_t>();
    for (std::uint32_t f = 0; f < fields; ++f) {
        std::string name(in.get<std::uint8_t>(), '\0');
        in.get(name.data(), name.size());
        const auto value = in.get<double>();
        for (const RetiredOption& retired : retiredOptions())
            if (name == retired.name && value != 0.0) refuse(retired);
        forEachNumber(params, [&](const OptionRow& row, auto& member) {
            using Member = std::remove_reference_t<decltype(member)>;
            if (!row.isNamed(name)) return;
            if (!(std::abs(value) < std::numeric_limits<int>::max()))
                throw FormatError("saved map: parameter " + name + " is out of range");
            member = static_cast<Member>(value);
        });
    }
    try {
        params.validate();
    } catch (const std::invalid_argument& e) {
        throw FormatError(std::string("saved map: parameter ") + e.what());
    }
    return params;
}

/// Returns a reader behind the header of a buffer that is whole and undamaged.
Reader openBuffer(const std::uint8_t* data, std::size_t size, std::uint32_t& version) {
    Reader in(data, size);
    char magic[4] = {};
    if (size >= sizeof(magic)) in.get(magic, sizeof(magic));
    if (std::memcmp(magic, kMagic, sizeof(magic)) != 0)
        throw FormatError("not a saved HGMM map");
    version = in.get<std::uint32_t>();
    if (version < 1 || version > kVersion)
        throw FormatError("saved map of format version " + std::to_string(version) +
                          ": this library reads versions 1 to " + std::to_string(kVersion));
    const auto whole = in.get<std::uint64_t>();
    if (whole != size)
        throw FormatError("saved map: " + std::to_string(whole) + " bytes were written, " +
                          std::to_string(size) + " are here");
    if (in.get<std::uint64_t>() != checksum(data + kHeader, size - kHeader))
        throw FormatError("saved map: it is damaged (checksum)");
    return in;
}

std::vector<int> octavesOf(const FreeSpace& space) {
    std::vector<int> octaves;
    for (std::size_t i = 0; i < space.mixture().size(); ++i)
        octaves.push_back(space.octave(i));
    return octaves;
}

FreeSpace freeSpaceFrom(const Mixture<4>& mixture, const std::vector<int>& octaves) {
    FreeSpace space;
    space.reserve(mixture.size());
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        if (std::abs(octaves[i]) > 40)
            throw FormatError("saved map: the octave of a free component is out of range");
        space.pushBack(mixture[i], octaves[i]);
    }
    return space;
}

template <int D>
void checkMixture(const Mixture<D>& mixture) {
    try {
        mixture.check();
    } catch (const std::logic_error& e) {
        throw FormatError(std::string("saved map: ") + e.what());
    }
}

void checkViewDirections(const ViewDirections& views) {
    constexpr double kTolerance = 1e-2;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ViewDirection view = views[i];
        if (!(view.range_m >= 0.0 && view.range_m <= kMaxCoordinate_m))
            throw FormatError("saved map: the range of a view is out of range");
        if (view.known() && !(std::abs(view.direction.norm() - 1.0) <= kTolerance))
            throw FormatError("saved map: the direction of a view is not of unit length");
    }
}

/// Free components of the surfaces' own: of a model that maps had before version 0.2.
void refuseFreeOfSurfaces(const Mixture<4>& freeOfSurfaces) {
    if (!freeOfSurfaces.empty()) refuse(retiredOptions().front());
}

void putComponents(Writer& out, const Model& model, Encoding encoding) {
    const Mixture<3>& surfaces = model.components.surfaces();
    const ViewDirections& views = model.components.viewDirections();
    const Mixture<4>& free = model.freeSpace.mixture();
    const std::vector<int> octaves = octavesOf(model.freeSpace);
    out.put(static_cast<std::uint8_t>(encoding));
    if (encoding == Encoding::compact) {
        putSection(out, [&](auto& b) {
            encodeSurfaces(surfaces, views, blockOrder(surfaces), b);
        });
        putSection(out, [&](auto& b) { encodeFree(free, octaves, blockOrder(free), b); });
        // Once the thesis' own free space; the format has its place.
        putSection(out, [&](auto& b) { encodeFree({}, {}, {}, b); });
        return;
    }
    putMixture(out, surfaces);
    views.forEachArray([&](const std::vector<float>& a) { out.put(a.data(), a.size()); });
    putMixture(out, free);
    for (const int octave : octaves) out.put(static_cast<std::int8_t>(octave));
    putMixture(out, Mixture<4>());
}

void getExact(Reader& in, std::uint32_t version, Model& model) {
    Mixture<3> surfaces = getMixture<3>(in);
    checkMixture(surfaces);
    ViewDirections views;
    for (std::size_t i = 0; i < surfaces.size(); ++i) views.pushBack({});
    if (version > 1) {
        views.forEachArray(
            [&](std::vector<float>& array) { in.get(array.data(), array.size()); });
        checkViewDirections(views);
    }
    model.components = ComponentStore(std::move(surfaces), std::move(views));
    if (version == 1) return;
    const Mixture<4> free = getMixture<4>(in);
    std::vector<int> octaves(free.size());
    for (int& octave : octaves) octave = in.get<std::int8_t>();
    checkMixture(free);
    model.freeSpace = freeSpaceFrom(free, octaves);
    refuseFreeOfSurfaces(getMixture<4>(in));
}

void getCompact(Reader& in, Model& model) {
    Mixture<3> surfaces;
    ViewDirections views;
    getSection(in, [&](const std::uint8_t* data, std::size_t bytes) {
        return decodeSurfaces(data, bytes, surfaces, views);
    });
    checkMixture(surfaces);
    model.components = ComponentStore(std::move(surfaces), std::move(views));
    Mixture<4> free, ofSurfaces;
    std::vector<int> octaves, none;
    getSection(in, [&](const std::uint8_t* data, std::size_t bytes) {
        return decodeFree(data, bytes, free, octaves);
    });
    checkMixture(free);
    model.freeSpace = freeSpaceFrom(free, octaves);
    getSection(in, [&](const std::uint8_t* data, std::size_t bytes) {
        return decodeFree(data, bytes, ofSurfaces, none);
    });
    refuseFreeOfSurfaces(ofSurfaces);
}

void getComponents(Reader& in, std::uint32_t version, Model& model) {
    const auto encoding =
        version == 1 ? static_cast<std::uint8_t>(Encoding::exact) : in.get<std::uint8_t>();
    if (encoding == static_cast<std::uint8_t>(Encoding::compact))
        getCompact(in, model);
    else if (encoding == static_cast<std::uint8_t>(Encoding::exact))
        getExact(in, version, model);
    else
        throw FormatError("saved map: unknown encoding " + std::to_string(encoding));
}

void putCoverage(Writer& out, const Coverage& coverage, Encoding encoding) {
    putSection(out, [&](auto& bytes) {
        if (encoding == Encoding::compact)
            encodeCoverage(coverage, bytes);
        else
            writeCoverage(coverage, bytes);
    });
}

void getCoverage(Reader& in, Coverage& coverage) {
    getSection(in, [&](const std::uint8_t* bytes, std::size_t n) {
        return decodeCoverage(bytes, n, coverage);
    });
}

}  // namespace

std::vector<std::uint8_t> Map::save(Encoding encoding) const {
    const Model& model = state_->model;
    const bool hasOpenings = encoding == Encoding::exact ? !model.openings.empty()
                                                         : !model.openings.cells().empty();
    std::vector<std::uint8_t> buffer;
    Writer out(buffer);
    out.put(kMagic, sizeof(kMagic));
    out.put(hasOpenings ? kWithOpenings : kWithCoverage);
    out.put(std::uint64_t{0});
    out.put(std::uint64_t{0});
    putParams(out, model.params);
    out.put(model.origin.data(), 3);
    putComponents(out, model, encoding);
    putCoverage(out,
                encoding == Encoding::compact ? model.coverage.pruned() : model.coverage,
                encoding);
    if (hasOpenings) {
        putCoverage(out, model.openings.cells(), encoding);
        putCoverage(out, encoding == Encoding::exact ? model.openings.once() : Coverage(),
                    encoding);
    }
    putModalities(out, model.params, model.modalities, encoding);

    const std::uint64_t size = buffer.size();
    const std::uint64_t sum = checksum(buffer.data() + kHeader, size - kHeader);
    std::memcpy(buffer.data() + 8, &size, sizeof(size));
    std::memcpy(buffer.data() + 16, &sum, sizeof(sum));
    return buffer;
}

Map Map::load(const std::uint8_t* data, std::size_t size) try {
    std::uint32_t version = 0;
    Reader in = openBuffer(data, size, version);
    Map map(getParams(in));
    Model& model = map.state_->model;
    in.get(model.origin.data(), 3);
    if (!(model.origin.cwiseAbs().maxCoeff() <= kMaxPosition_m))
        throw FormatError("saved map: its origin is not finite or farther than 1e8 m");
    getComponents(in, version, model);
    if (version < kWithCoverage)
        model.coverage =
            guessedCoverage(model.components.surfaces(), model.components.viewDirections(),
                            model.freeSpace.mixture(), model.params.occupancy);
    else
        getCoverage(in, model.coverage);
    if (version >= kWithOpenings) {
        Coverage cells, once;
        getCoverage(in, cells);
        getCoverage(in, once);
        model.openings = Openings(std::move(cells), std::move(once));
    }
    if (version > kWithoutModalities) model.modalities = getModalities(in, model.params);
    if (in.left() != 0) throw FormatError("saved map: bytes are left over at its end");
    return map;
} catch (const std::out_of_range& e) {
    throw FormatError(std::string("saved map: ") + e.what());
}

}  // namespace hgmm
