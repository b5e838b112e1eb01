#include "archive.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

namespace hgmm::python {

namespace {

const std::string kClassName = "mrpt::maps::CHGMMOccupancyMap";
constexpr std::uint8_t kNewestVersion = 2, kFlags = 7, kEnd = 0x88;
/// MRPT marks the length of a name so, where a version and an end mark follow.
constexpr std::uint8_t kMarksName = 0x80;

[[noreturn]] void fail(const std::string& what) {
    throw FormatError("not a map that can be read: " + what);
}

class Reader {
 public:
    explicit Reader(const std::vector<std::uint8_t>& bytes)
        : at_(bytes.data()), end_(at_ + bytes.size()) {}

    const std::uint8_t* take(std::uint64_t n) {
        if (n > static_cast<std::uint64_t>(end_ - at_)) fail("it lost its end");
        return std::exchange(at_, at_ + n);
    }
    template <typename Number>
    Number number() {
        Number value;
        std::memcpy(&value, take(sizeof value), sizeof value);
        return value;
    }
    template <typename Length>
    std::string text() {
        const auto size = number<Length>();
        return {reinterpret_cast<const char*>(take(size)), size};
    }
    bool isAtEnd() const { return at_ == end_; }

 private:
    const std::uint8_t *at_, *end_;
};

class Writer {
 public:
    template <typename Number>
    void number(Number value) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
    }
    template <typename Length>
    void text(const std::string& text) {
        number(static_cast<Length>(text.size()));
        bytes_.insert(bytes_.end(), text.begin(), text.end());
    }
    void bytes(const std::vector<std::uint8_t>& more) {
        bytes_.insert(bytes_.end(), more.begin(), more.end());
    }
    std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
    std::vector<std::uint8_t> bytes_;
};

/// Options of insertion that say how MRPT's observations are read, and those of version 0
/// that nothing depends on.
constexpr const char* kOthers[] = {"considerInvalidRangesAsFreeSpace",
                                   "considerNoReturnsAsFreeSpace",
                                   "clearedShareOfRange",
                                   "intensityScale",
                                   "leafPerRange",
                                   "cellPerRange"};

void requireKnown(const std::string& name) {
    bool known =
        std::find(std::begin(kOthers), std::end(kOthers), name) != std::end(kOthers);
    const MapParams params;
    forEachOption(params,
                  [&](const OptionRow& row, const auto&) { known |= row.isNamed(name); });
    for (const RetiredOption& retired : retiredOptions()) known |= name == retired.name;
    if (!known) fail("it holds an option '" + name + "' that this version does not know");
}

/// Numbers, then from version 2 on texts. The model's buffer has those of the model, too.
template <typename Visitor>
void skipOptions(Reader& in, std::uint8_t version, Visitor&& visit) {
    for (unsigned left = in.number<std::uint8_t>(); left > 0; --left) {
        visit(in.text<std::uint8_t>());
        in.number<double>();
    }
    if (version < 2) return;
    for (unsigned left = in.number<std::uint8_t>(); left > 0; --left) {
        visit(in.text<std::uint8_t>());
        in.text<std::uint16_t>();
    }
}

std::string listed(const Names& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

void writeInsertionOptions(Writer& out, const MapParams& params) {
    std::uint8_t count = 0;
    forEachNumber(params, [&](const OptionRow&, double) { ++count; });
    out.number(count);
    forEachNumber(params, [&](const OptionRow& row, double value) {
        out.text<std::uint8_t>(row.name);
        out.number(value);
    });
    out.number<std::uint8_t>(1);
    out.text<std::uint8_t>("modalities");
    out.text<std::uint16_t>(listed(params.modalities));
}

}  // namespace

std::vector<std::uint8_t> unwrapped(const std::vector<std::uint8_t>& object) {
    Reader in(object);
    const auto length = in.number<std::uint8_t>();
    if ((length & kMarksName) == 0) fail("no object of MRPT");
    const std::uint8_t* name = in.take(length & ~kMarksName);
    if (const std::string found(name, name + (length & ~kMarksName)); found != kClassName)
        fail("no " + kClassName + " is in it");
    const auto version = in.number<std::uint8_t>();
    if (version > kNewestVersion)
        fail("version " + std::to_string(version) + " is newer than this program's " +
             std::to_string(kNewestVersion));
    if (in.number<std::uint8_t>() > kFlags) fail("its generic map parameters are damaged");
    skipOptions(in, version, requireKnown);
    for (int ofMrpt = 0; ofMrpt < 2; ++ofMrpt)
        skipOptions(in, version, [](const std::string&) {});
    const auto size = in.number<std::uint64_t>();
    const std::uint8_t* buffer = in.take(size);
    if (in.number<std::uint8_t>() != kEnd || !in.isAtEnd())
        fail("it does not end as it should");
    return {buffer, buffer + size};
}

std::vector<std::uint8_t> wrapped(const Map& map, Encoding encoding) {
    Writer out;
    out.number(static_cast<std::uint8_t>(kMarksName | kClassName.size()));
    for (const char c : kClassName) out.number(c);
    out.number(kNewestVersion);
    out.number(kFlags);
    writeInsertionOptions(out, map.params());
    // A likelihood option that is not there gets its default, but for this one, whose
    // default was another in files without it.
    out.number<std::uint8_t>(1);
    out.text<std::uint8_t>("independentPoints");
    out.number(0.0);
    out.number<std::uint8_t>(0);
    out.number<std::uint16_t>(0);  // render options, numbers and texts: none
    const std::vector<std::uint8_t> buffer = map.save(encoding);
    out.number(static_cast<std::uint64_t>(buffer.size()));
    out.bytes(buffer);
    out.number(kEnd);
    return out.take();
}

}  // namespace hgmm::python
