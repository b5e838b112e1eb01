#include "saved_bytes.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

namespace equality {
namespace {

const std::string kMagic = "HGMM";
constexpr std::size_t kVersionEnd = 8;  // behind magic and version
constexpr std::size_t kHeaderEnd = 24;  // behind size and checksum

}  // namespace

std::vector<std::uint8_t> withoutOptions(const std::vector<std::uint8_t>& saved) {
    std::uint32_t options = 0;
    if (saved.size() < kHeaderEnd + sizeof options ||
        !std::equal(kMagic.begin(), kMagic.end(), saved.begin()))
        throw std::runtime_error("bytes that are no saved map");
    std::memcpy(&options, saved.data() + kHeaderEnd, sizeof options);
    std::size_t at = kHeaderEnd + sizeof options;
    for (; options > 0; --options) at += 1 + saved.at(at) + sizeof(double);
    if (at > saved.size()) throw std::runtime_error("options of a saved map have no end");
    std::vector<std::uint8_t> rest(saved.begin(), saved.begin() + kVersionEnd);
    rest.insert(rest.end(), saved.begin() + static_cast<std::ptrdiff_t>(at), saved.end());
    return rest;
}

std::vector<std::uint8_t> withoutOptionsOfObject(const std::vector<std::uint8_t>& object) {
    const auto nextMagic = [&](auto from) {
        return std::search(from, object.end(), kMagic.begin(), kMagic.end());
    };
    // The name of the class has these letters, too, but no length behind them.
    const auto isBuffer = [&](auto at) {
        std::uint64_t size = 0;
        const auto left = static_cast<std::size_t>(object.end() - at);
        if (left < kHeaderEnd) return false;
        std::memcpy(&size, &*at + kVersionEnd, sizeof size);
        return size <= left;
    };
    for (auto at = nextMagic(object.begin()); at != object.end(); at = nextMagic(at + 1))
        if (isBuffer(at)) return withoutOptions({at, object.end()});
    throw std::runtime_error("an MRPT object that holds no saved map");
}

}  // namespace equality
