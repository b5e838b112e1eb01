#include "lzf.h"

#include <stdexcept>

namespace hgmm::importer {
namespace {

/// The bytes of a block, one after the other.
class ByteReader {
 public:
    explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
    bool atEnd() const { return next_ == bytes_.size(); }
    std::size_t get() {
        if (atEnd()) throw std::runtime_error("the compressed data ends too early");
        return static_cast<unsigned char>(bytes_[next_++]);
    }

 private:
    const std::string& bytes_;
    std::size_t next_ = 0;
};

}  // namespace

std::string unpackLzf(const std::string& packed, std::size_t size) {
    constexpr std::size_t firstRepetition = 32;
    constexpr std::size_t longLength = 7;
    ByteReader in(packed);
    std::string out;
    while (!in.atEnd()) {
        const std::size_t control = in.get();
        if (control < firstRepetition) {
            for (std::size_t i = 0; i <= control; ++i)
                out.push_back(static_cast<char>(in.get()));
        } else {
            std::size_t length = control >> 5;
            if (length == longLength) length += in.get();
            const std::size_t distance = ((control & 31) << 8) + in.get() + 1;
            if (distance > out.size())
                throw std::runtime_error("the compressed data is damaged");
            // Byte by byte: a repetition may overlap itself.
            for (std::size_t i = 0; i < length + 2; ++i)
                out.push_back(out[out.size() - distance]);
        }
        if (out.size() > size) break;
    }
    if (out.size() != size)
        throw std::runtime_error(
            "the compressed data does not unpack to the size that it states");
    return out;
}

}  // namespace hgmm::importer
