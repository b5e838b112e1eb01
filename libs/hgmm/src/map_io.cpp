#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "hgmm/map.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "saved maps are little-endian");
static_assert(std::numeric_limits<float>::is_iec559 &&
                  std::numeric_limits<double>::is_iec559,
              "saved maps hold IEEE 754 numbers");

namespace hgmm {

namespace {

// Layout of version 1:
//   char[4] "HGMM", u32 version, u64 size of the whole buffer, u64 checksum of what
//   follows, u32 fields, then each: u8 length, name, f64 value   (MapParams) f64[3] origin,
//   u64 components, then f32 arrays: support, mean x y z, covariance xx xy xz yy yz zz
constexpr char kMagic[4] = {'H', 'G', 'M', 'M'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 24;

/// 64-bit checksum, eight bytes at a time: copies inside a particle filter go through here.
std::uint64_t checksum(const std::uint8_t* data, std::size_t size) {
    std::uint64_t h = 0xCBF29CE484222325ULL ^ size;
    const auto mix = [&h](std::uint64_t word) {
        h = (h ^ word) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 32U;
    };
    for (; size >= 8; data += 8, size -= 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, data, 8);
        mix(word);
    }
    std::uint64_t tail = 0;
    std::memcpy(&tail, data, size);
    mix(tail);
    return h;
}

class Writer {
 public:
    template <typename T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        put(&value, 1);
    }
    template <typename T>
    void put(const T* values, std::size_t n) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
        buffer.insert(buffer.end(), bytes, bytes + n * sizeof(T));
    }
    std::vector<std::uint8_t> buffer;
};

class Reader {
 public:
    Reader(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    template <typename T>
    T get() {
        T value{};
        get(&value, 1);
        return value;
    }
    template <typename T>
    void get(T* values, std::size_t n) {
        if (n > left_ / sizeof(T)) throw FormatError("saved map: it ends too early");
        if (n == 0) return;
        std::memcpy(values, data_, n * sizeof(T));
        data_ += n * sizeof(T);
        left_ -= n * sizeof(T);
    }
    std::size_t left() const { return left_; }

 private:
    const std::uint8_t* data_;
    std::size_t left_;
};

template <typename Mix, typename Visitor>
void forEachArray(Mix& mixture, Visitor&& visit) {
    visit(mixture.support);
    for (auto& axis : mixture.mean) visit(axis);
    for (auto& entry : mixture.covariance) visit(entry);
}

void putParams(Writer& out, const MapParams& params) {
    std::uint32_t fields = 0;
    forEachField(params, [&](const char*, const auto&) { ++fields; });
    out.put(fields);
    forEachField(params, [&](const char* name, const auto& value) {
        const auto length = static_cast<std::uint8_t>(std::strlen(name));
        out.put(length);
        out.put(name, length);
        out.put(static_cast<double>(value));
    });
}

/// Fields are found by name: one that a file does not hold keeps its default.
MapParams getParams(Reader& in) {
    MapParams params;
    const auto fields = in.get<std::uint32_t>();
    for (std::uint32_t f = 0; f < fields; ++f) {
        std::string name(in.get<std::uint8_t>(), '\0');
        in.get(name.data(), name.size());
        const auto value = in.get<double>();
        forEachField(params, [&](const char* known, auto& member) {
            using Member = std::remove_reference_t<decltype(member)>;
            if (name != known) return;
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

Mixture<3> getMixture(Reader& in) {
    constexpr std::size_t bytesPerComponent = sizeof(float) * (1 + 3 + Mixture<3>::packed);
    const auto n = in.get<std::uint64_t>();
    if (n > in.left() / bytesPerComponent)
        throw FormatError("saved map: it ends too early");
    Mixture<3> mixture;
    forEachArray(mixture, [&](std::vector<float>& array) {
        array.resize(n);
        in.get(array.data(), n);
    });
    return mixture;
}

/// Returns a reader behind the header of a buffer that is whole and undamaged.
Reader openBuffer(const std::uint8_t* data, std::size_t size) {
    Reader in(data, size);
    char magic[4] = {};
    if (size >= sizeof(magic)) in.get(magic, sizeof(magic));
    if (std::memcmp(magic, kMagic, sizeof(magic)) != 0)
        throw FormatError("not a saved HGMM map");
    const auto version = in.get<std::uint32_t>();
    if (version != kVersion)
        throw FormatError("saved map of format version " + std::to_string(version) +
                          ": this library reads version " + std::to_string(kVersion));
    const auto whole = in.get<std::uint64_t>();
    if (whole != size)
        throw FormatError("saved map: " + std::to_string(whole) + " bytes were written, " +
                          std::to_string(size) + " are here");
    if (in.get<std::uint64_t>() != checksum(data + kHeader, size - kHeader))
        throw FormatError("saved map: it is damaged (checksum)");
    return in;
}

}  // namespace

std::vector<std::uint8_t> Map::save() const {
    Writer out;
    out.buffer.reserve(1024 + base_.size() * sizeof(float) * (1 + 3 + Mixture<3>::packed));
    out.put(kMagic, sizeof(kMagic));
    out.put(kVersion);
    out.put(std::uint64_t{0});
    out.put(std::uint64_t{0});
    putParams(out, params_);
    out.put(origin_.data(), 3);
    out.put(static_cast<std::uint64_t>(base_.size()));
    forEachArray(base_, [&](const std::vector<float>& a) { out.put(a.data(), a.size()); });

    const std::uint64_t size = out.buffer.size();
    const std::uint64_t sum = checksum(out.buffer.data() + kHeader, size - kHeader);
    std::memcpy(out.buffer.data() + 8, &size, sizeof(size));
    std::memcpy(out.buffer.data() + 16, &sum, sizeof(sum));
    return std::move(out.buffer);
}

Map Map::load(const std::uint8_t* data, std::size_t size) {
    Reader in = openBuffer(data, size);
    Map map(getParams(in));
    in.get(map.origin_.data(), 3);
    map.base_ = getMixture(in);
    if (in.left() != 0) throw FormatError("saved map: bytes are left over at its end");
    if (!map.origin_.allFinite()) throw FormatError("saved map: its origin is not finite");
    try {
        map.base_.check();
    } catch (const std::logic_error& e) {
        throw FormatError(std::string("saved map: ") + e.what());
    }
    return map;
}

}  // namespace hgmm
