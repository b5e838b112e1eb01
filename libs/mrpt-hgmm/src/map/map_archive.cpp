#include "map/map_archive.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "options/option_fields.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::serialization::CArchive;

namespace hgmm::mrpt_bridge {

namespace {

// Layout: u8 flags of the generic map parameters; insertion, likelihood and
// render options, each as
//   u8 fields, then each: u8 length, name, f64 value
//   from version 2 on, options that are texts: u8 fields, then each: u8 length, name, u16
//   length, text
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

template <typename Length>
void writeText(CArchive& out, const std::string& text) {
    if (text.size() > std::numeric_limits<Length>::max())
        fail("the option '" + text.substr(0, 40) + "...' is too long to be stored");
    out << static_cast<Length>(text.size());
    out.WriteBuffer(text.data(), text.size());
}

template <typename Length>
std::string readText(CArchive& in) {
    std::string text(in.ReadAs<Length>(), '\0');
    readExactly(in, text.data(), text.size());
    return text;
}

template <typename Options>
void writeOptions(CArchive& out, Options options) {
    const OptionFields fields = fieldsOf(options);
    const auto texts = std::count_if(fields.begin(), fields.end(),
                                     [](const OptionField& f) { return f.isText(); });
    for (const bool text : {false, true}) {
        out << static_cast<std::uint8_t>(text ? texts : fields.size() - texts);
        for (const OptionField& field : fields) {
            if (field.isText() != text) continue;
            writeText<std::uint8_t>(out, field.row->name);
            if (text)
                writeText<std::uint16_t>(out, textOf(field));
            else
                out << numberOf(field);
        }
    }
}

/// Whether an option has no counterpart now and nothing depends on it: how the stored model
/// was built. The buffer of the model has a word on what it was built with, too.
bool isRetired(const std::string& name, std::uint8_t version) {
    if (version == 0 && (name == "leafPerRange" || name == "cellPerRange")) return true;
    const auto& retired = retiredOptions();
    return std::any_of(retired.begin(), retired.end(),
                       [&](const RetiredOption& option) { return option.name == name; });
}

/// The field of a name and kind; nothing for one that does not matter any more.
const OptionField* findStored(const OptionFields& fields, const std::string& name,
                              bool isText, std::uint8_t version) {
    for (const OptionField& field : fields)
        if (field.isText() == isText && field.row->isNamed(name)) return &field;
    if (!isText && isRetired(name, version)) return nullptr;
    fail("it holds an option '" + name + "' that this version does not know");
}

/// Sets options to what they amounted to before they were there, if that is not the
/// default.
template <typename Options>
void setFormer(Options&) {}
void setFormer(CHGMMOccupancyMap::TLikelihoodOptions& options) {
    options.independentPoints = kMaxPoints;
}

/// Fields are found by name; one that is not stored keeps its former meaning or default.
template <typename Options>
Options readOptions(CArchive& in, std::uint8_t version) {
    Options options;
    setFormer(options);
    const OptionFields fields = fieldsOf(options);
    for (unsigned left = in.ReadAs<std::uint8_t>(); left > 0; --left) {
        const auto name = readText<std::uint8_t>(in);
        const auto value = in.ReadAs<double>();
        if (const auto* field = findStored(fields, name, false, version))
            setNumber(*field, value);
    }
    if (version < 2) return options;
    for (unsigned left = in.ReadAs<std::uint8_t>(); left > 0; --left) {
        const auto name = readText<std::uint8_t>(in);
        const auto text = readText<std::uint16_t>(in);
        setText(*findStored(fields, name, true, version), text, name);
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

std::uint64_t digestOf(const std::vector<std::uint8_t>& bytes) {
    std::uint64_t digest = bytes.size();
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, &bytes[i], std::min(sizeof(word), bytes.size() - i));
        digest = (digest ^ word) * 0x9E3779B97F4A7C15ULL;
        digest ^= digest >> 32U;
    }
    return digest;
}

}  // namespace

std::uint64_t writeMap(CArchive& out, const CHGMMOccupancyMap& map, Encoding encoding) {
    out << flagsOf(map.genericMapParams);
    writeOptions(out, map.insertionOptions);
    writeOptions(out, map.likelihoodOptions);
    writeOptions(out, map.renderOptions);
    const std::vector<std::uint8_t> buffer = map.model().save(encoding);
    out << static_cast<std::uint64_t>(buffer.size());
    out.WriteBuffer(buffer.data(), buffer.size());
    return digestOf(buffer);
}

std::uint64_t readMap(CArchive& in, std::uint8_t version, CHGMMOccupancyMap& map) {
    if (version > kArchiveVersion)
        fail("stored in version " + std::to_string(version) +
             ", newer than this program's " + std::to_string(kArchiveVersion));
    mrpt::maps::TMapGenericParams generic;
    setFlags(in.ReadAs<std::uint8_t>(), generic);
    const auto insertion = readOptions<CHGMMOccupancyMap::TInsertionOptions>(in, version);
    const auto likelihood = readOptions<CHGMMOccupancyMap::TLikelihoodOptions>(in, version);
    const auto render = readOptions<CHGMMOccupancyMap::TRenderOptions>(in, version);
    insertion.params.validate();
    insertion.reading.validate();
    likelihood.validate();
    render.validate();
    const std::vector<std::uint8_t> buffer = readBuffer(in);
    map.model() = Map::load(buffer.data(), buffer.size());
    map.genericMapParams = generic;
    map.insertionOptions = insertion;
    map.likelihoodOptions = likelihood;
    map.renderOptions = render;
    return digestOf(buffer);
}

}  // namespace hgmm::mrpt_bridge
