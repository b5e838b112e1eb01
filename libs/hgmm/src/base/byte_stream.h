#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace hgmm {

/// Appends plain values to a buffer.
class Writer {
 public:
    explicit Writer(std::vector<std::uint8_t>& buffer) : buffer_(buffer) {}

    template <typename T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        put(&value, 1);
    }
    template <typename T>
    void put(const T* values, std::size_t n) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(values);
        buffer_.insert(buffer_.end(), bytes, bytes + n * sizeof(T));
    }

 private:
    std::vector<std::uint8_t>& buffer_;
};

/// Reads plain values from a buffer. Throws std::out_of_range where it ends too early.
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
        if (n > left_ / sizeof(T)) throw std::out_of_range("it ends too early");
        if (n == 0) return;
        std::memcpy(values, data_, n * sizeof(T));
        skip(n * sizeof(T));
    }

    std::size_t left() const { return left_; }
    const std::uint8_t* here() const { return data_; }
    /// @param n at most left()
    void skip(std::size_t n) {
        data_ += n;
        left_ -= n;
    }

 private:
    const std::uint8_t* data_;
    std::size_t left_;
};

}  // namespace hgmm
