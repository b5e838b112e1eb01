#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/byte_stream.h"
#include "hgmm/map.h"
#include "hgmm/scan.h"
#include "io/checksum.h"

/// States of objects that another process goes on from, bit for bit. StateWriter and
/// StateReader take the same calls, so that the order of fields is told once for both:
///   template <typename Archive> void archive(Archive& a, State& s) { a(s.pose, s.count); }
/// Layout: char[4] magic, u32 version, u64 size of the whole buffer, u64 checksum of what
/// follows, fields.
namespace hgmm {

/// What a state begins with.
struct StateKind {
    std::array<char, 4> magic;
    std::uint32_t version;
    const char* name;  ///< for messages
};

constexpr std::size_t kStateHeader = 24;

template <typename T>
constexpr bool isPlain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Appends fields, which stay as they are.
class StateWriter {
 public:
    explicit StateWriter(const StateKind& kind) {
        put_.put(kind.magic.data(), kind.magic.size());
        put_.put(kind.version);
        put_.put(std::uint64_t{0});
        put_.put(std::uint64_t{0});
    }
    StateWriter(const StateWriter&) = delete;
    StateWriter& operator=(const StateWriter&) = delete;

    template <typename... T>
    void operator()(const T&... fields) {
        (one(fields), ...);
    }
    template <typename T, typename Visit>
    void optional(std::optional<T>& field, Visit&& visit) {
        put_.put(std::uint8_t{field.has_value()});
        if (field) visit(*field);
    }
    /// Any sequence.
    template <typename Sequence, typename Visit>
    void each(Sequence& fields, Visit&& visit) {
        put_.put(static_cast<std::uint64_t>(fields.size()));
        for (auto& field : fields) visit(field);
    }

    std::vector<std::uint8_t> finish() && {
        const std::uint64_t size = buffer_.size();
        const std::uint64_t sum =
            checksum(buffer_.data() + kStateHeader, buffer_.size() - kStateHeader);
        std::memcpy(buffer_.data() + 8, &size, sizeof size);
        std::memcpy(buffer_.data() + 16, &sum, sizeof sum);
        return std::move(buffer_);
    }

 private:
    template <typename T>
    std::enable_if_t<isPlain<T>> one(const T& number) {
        put_.put(number);
    }
    template <typename T, int R, int C, int O>
    void one(const Eigen::Matrix<T, R, C, O>& matrix) {
        put_.put(matrix.data(), static_cast<std::size_t>(matrix.size()));
    }
    void one(const Pose& pose) { (*this)(pose.R, pose.t); }
    void one(const std::vector<std::uint8_t>& bytes) {
        put_.put(static_cast<std::uint64_t>(bytes.size()));
        put_.put(bytes.data(), bytes.size());
    }
    void one(const std::string& text) {
        put_.put(static_cast<std::uint64_t>(text.size()));
        put_.put(text.data(), text.size());
    }
    void one(const Map& map) { one(map.save(Encoding::exact)); }

    std::vector<std::uint8_t> buffer_;
    Writer put_{buffer_};
};

/// Reads them back. Throws FormatError for a buffer that is not whole or of another kind,
/// and std::out_of_range where it ends too early.
class StateReader {
 public:
    StateReader(const std::uint8_t* data, std::size_t size, const StateKind& kind)
        : get_(data, size) {
        const std::string name = std::string(kind.name) + ": ";
        std::array<char, 4> magic{};
        if (size >= kStateHeader) get_.get(magic.data(), magic.size());
        if (magic != kind.magic) throw FormatError(name + "it is none");
        const auto version = get_.get<std::uint32_t>();
        if (version != kind.version)
            throw FormatError(name + "format version " + std::to_string(version) +
                              ", where this library reads " + std::to_string(kind.version));
        if (get_.get<std::uint64_t>() != size) throw FormatError(name + "it is not whole");
        if (get_.get<std::uint64_t>() != checksum(data + kStateHeader, size - kStateHeader))
            throw FormatError(name + "it is damaged (checksum)");
    }

    template <typename... T>
    void operator()(T&... fields) {
        (one(fields), ...);
    }
    template <typename T, typename Visit>
    void optional(std::optional<T>& field, Visit&& visit) {
        field.reset();
        if (get_.get<std::uint8_t>() == 0) return;
        visit(field.emplace());
    }
    template <typename Sequence, typename Visit>
    void each(Sequence& fields, Visit&& visit) {
        const std::size_t n = count();
        fields.clear();
        for (std::size_t i = 0; i < n; ++i) visit(fields.emplace_back());
    }

 private:
    /// Of things that take a byte at least.
    std::size_t count() {
        const auto n = get_.get<std::uint64_t>();
        if (n > get_.left()) throw std::out_of_range("it ends too early");
        return static_cast<std::size_t>(n);
    }
    template <typename T>
    std::enable_if_t<isPlain<T>> one(T& number) {
        if constexpr (std::is_same_v<T, bool>) {
            const auto flag = get_.get<std::uint8_t>();
            if (flag > 1) throw std::out_of_range("a flag is neither 0 nor 1");
            number = flag == 1;
        } else {
            number = get_.get<T>();
        }
    }
    template <typename T, int R, int C, int O>
    void one(Eigen::Matrix<T, R, C, O>& matrix) {
        get_.get(matrix.data(), static_cast<std::size_t>(matrix.size()));
    }
    void one(Pose& pose) { (*this)(pose.R, pose.t); }
    void one(std::vector<std::uint8_t>& bytes) {
        bytes.resize(count());
        get_.get(bytes.data(), bytes.size());
    }
    void one(std::string& text) {
        text.resize(count());
        get_.get(text.data(), text.size());
    }
    void one(Map& map) {
        std::vector<std::uint8_t> bytes;
        one(bytes);
        map = Map::load(bytes.data(), bytes.size());
    }

    Reader get_;
};

}  // namespace hgmm
