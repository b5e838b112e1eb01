#include "map_archive.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "option_fields.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::serialization::CArchive;

namespace hgmm::mrpt_bridge {

namespace {

// Layout: u8 flags of the generic map parameters; insertion, likelihood and
// render options, each as
//   u8 fields, then each: u8 length, name, f64 value
// then u64 bytes and the buffer of hgmm::Map::save. Version 1 differs from 0 in the options
// that it holds.

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("CHGMMOccupancyMap: " + what);
}

/// CArchive::ReadBuffer reads less, without complaint, where a stream ends.
void readExactly(CArchive& in, void* data, std::size_t size) {
    if (size > 0 && in.ReadBuffer(data, size) != size) fail("the stream ends too early");
}

/// MRPT's own stream operator would take any byte of a damaged stream for a bool.
std::uint8_t flagsOf(const mrpt::maps::TMapGenericParams& p) {
    return static_cast<std::uint8_t>((p.enableSaveAs3DObject ? 1U : 0U) |
                                     (p.enableObservationLikelihood ? 2U : 0U) |
                                     (p.enableObservationInsertion ? 4U : 0U));
}

void setFlags(std::uint8_t flags, mrpt::maps::TMapGenericParams& p) {
    if (flags > 7) fail("its generic map parameters are damaged");
    p.enableSaveAs3DObject = (flags & 1U) != 0;
    p.enableObservationLikelihood = (flags & 2U) != 0;
    p.enableObservationInsertion = (flags & 4U) != 0;
}

template <typename Options>
void writeOptions(CArchive& out, Options options) {
    const OptionFields fields = fieldsOf(options);
    out << static_cast<std::uint8_t>(fields.size());
    for (const OptionField& field : fields) {
        const auto length = static_cast<std::uint8_t>(std::strlen(field.name));
        out << length;
        out.WriteBuffer(field.name, length);
        out << numberOf(field);
    }
}

/// Options of version 0 that have no counterpart now: how a stored model was built, which
/// nothing depends on.
bool isRetired(const std::string& name) {
    return name == "leafPerRange" || name == "cellPerRange";
}

/// Fields are found by name; one that is not stored keeps its default.
template <typename Options>
Options readOptions(CArchive& in, std::uint8_t version) {
    Options options;
    const OptionFields fields = fieldsOf(options);
    const auto count = in.ReadAs<std::uint8_t>();
    for (unsigned i = 0; i < count; ++i) {
        std::string name(in.ReadAs<std::uint8_t>(), '\0');
        readExactly(in, name.data(), name.size());
        const auto value = in.ReadAs<double>();
        const auto field =
            std::find_if(fields.begin(), fields.end(),
                         [&](const OptionField& f) { return f.isStoredAs(name); });
        if (field == fields.end() && version == 0 && isRetired(name)) continue;
        if (field == fields.end())
            fail("it holds an option '" + name + "' that this version does not know");
        setNumber(*field, value);
    }
    return options;
}

/// In steps, so that a damaged length cannot ask for more memory than the stream fills.
std::vector<std::uint8_t> readBuffer(CArchive& in) {
    constexpr std::uint64_t step = std::uint64_t{1} << 24U;
    const auto size = in.ReadAs<std::uint64_t>();
    std::vector<std::uint8_t> buffer;
    while (buffer.size() < size) {
        const std::size_t begin = buffer.size();
        buffer.resize(begin + std::min(step, size - begin));
        readExactly(in, buffer.data() + begin, buffer.size() - begin);
    }
    return buffer;
}

}  // namespace

void writeMap(CArchive& out, const CHGMMOccupancyMap& map, Encoding encoding) {
    out << flagsOf(map.genericMapParams);
    writeOptions(out, map.insertionOptions);
    writeOptions(out, map.likelihoodOptions);
    writeOptions(out, map.renderOptions);
    const std::vector<std::uint8_t> buffer = map.model().save(encoding);
    out << static_cast<std::uint64_t>(buffer.size());
    out.WriteBuffer(buffer.data(), buffer.size());
}

void readMap(CArchive& in, std::uint8_t version, CHGMMOccupancyMap& map) {
    if (version > kArchiveVersion)
        fail("stored in version " + std::to_string(version) +
             ", newer than this program's " + std::to_string(kArchiveVersion));
    mrpt::maps::TMapGenericParams generic;
    setFlags(in.ReadAs<std::uint8_t>(), generic);
    const auto insertion = readOptions<CHGMMOccupancyMap::TInsertionOptions>(in, version);
    const auto likelihood = readOptions<CHGMMOccupancyMap::TLikelihoodOptions>(in, version);
    const auto render = readOptions<CHGMMOccupancyMap::TRenderOptions>(in, version);
    insertion.params.validate();
    likelihood.validate();
    render.validate();
    const std::vector<std::uint8_t> buffer = readBuffer(in);
    map.model() = Map::load(buffer.data(), buffer.size());
    map.genericMapParams = generic;
    map.insertionOptions = insertion;
    map.likelihoodOptions = likelihood;
    map.renderOptions = render;
}

}  // namespace hgmm::mrpt_bridge
