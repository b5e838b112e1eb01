#pragma once
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace hgmm {

/// P(bit = 1), learnt from the bits that were coded with it: the mean of a quick and a slow
/// estimate.
class BitModel {
 public:
    /// P(1) in units of 2^-16, in [1, 65535].
    std::uint32_t probability() const { return (std::uint32_t{quick_} + slow_) / 2; }
    void learn(bool bit) {
        move(quick_, 4, bit);
        move(slow_, 7, bit);
    }

 private:
    static void move(std::uint16_t& p, unsigned rate, bool bit) {
        p = static_cast<std::uint16_t>(bit ? p + ((65535U - p) >> rate) : p - (p >> rate));
    }
    std::uint16_t quick_ = 32768, slow_ = 32768;
};

/// Arithmetic coding of bits (Witten, Neal and Cleary 1987): the interval [low, high] is
/// divided by each bit's probability, and bytes that both bounds share are written.
class BitInterval {
 protected:
    std::uint32_t divide(const BitModel& model) const {
        return low_ + static_cast<std::uint32_t>(
                          (std::uint64_t{high_ - low_} * model.probability()) >> 16U);
    }
    void choose(bool bit, std::uint32_t middle) {
        if (bit)
            high_ = middle;
        else
            low_ = middle + 1;
    }
    bool hasByte() const { return ((low_ ^ high_) >> 24U) == 0; }
    void shift() {
        low_ <<= 8U;
        high_ = high_ << 8U | 255U;
    }
    std::uint32_t low_ = 0, high_ = 0xFFFFFFFFU;
};

class BitEncoder : private BitInterval {
 public:
    explicit BitEncoder(std::vector<std::uint8_t>& out) : out_(out) {}

    void put(bool bit, BitModel& model) {
        choose(bit, divide(model));
        model.learn(bit);
        for (; hasByte(); shift()) out_.push_back(static_cast<std::uint8_t>(high_ >> 24U));
    }
    /// After the last bit.
    void finish() {
        for (int k = 0; k < 4; ++k, shift())
            out_.push_back(static_cast<std::uint8_t>(low_ >> 24U));
    }

 private:
    std::vector<std::uint8_t>& out_;
};

/// Throws std::out_of_range if the data ends too early.
class BitDecoder : private BitInterval {
 public:
    BitDecoder(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {
        for (int k = 0; k < 4; ++k) next();
    }

    bool get(BitModel& model) {
        const std::uint32_t middle = divide(model);
        const bool bit = code_ <= middle;
        choose(bit, middle);
        model.learn(bit);
        for (; hasByte(); shift()) next();
        return bit;
    }
    /// Bytes that were read: once all bits are, those that the encoder wrote.
    std::size_t read() const { return read_; }

 private:
    void next() {
        if (read_ == size_) throw std::out_of_range("it ends too early");
        code_ = code_ << 8U | data_[read_++];
    }
    const std::uint8_t* data_;
    std::size_t size_, read_ = 0;
    std::uint32_t code_ = 0;
};

}  // namespace hgmm
