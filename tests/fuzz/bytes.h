#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace hgmm::fuzz {

/// Hands out a fuzzer's bytes as choices and numbers; zeros once they are used up.
class Bytes {
 public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

    bool empty() const { return left_ == 0; }
    const std::uint8_t* here() const { return data_; }
    std::size_t left() const { return left_; }

    template <typename T>
    T raw() {
        T value{};
        const std::size_t n = left_ < sizeof(T) ? left_ : sizeof(T);
        if (n > 0) std::memcpy(&value, data_, n);
        data_ += n;
        left_ -= n;
        return value;
    }
    bool coin() { return (raw<std::uint8_t>() & 1U) != 0; }
    /// One of 0 .. n - 1, for n in [1, 256].
    unsigned below(unsigned n) { return raw<std::uint8_t>() % n; }
    /// In [low, high].
    double between(double low, double high) {
        return low + (high - low) * raw<std::uint16_t>() / 65535.0;
    }
    /// In [low, high], each octave as often as another; low > 0.
    double magnitude(double low, double high) {
        return std::exp(between(std::log(low), std::log(high)));
    }

 private:
    const std::uint8_t* data_;
    std::size_t left_;
};

}  // namespace hgmm::fuzz
