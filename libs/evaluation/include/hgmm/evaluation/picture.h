#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace hgmm::evaluation {

/// 8-bit RGB, row by row from the top.
struct Picture {
    int width_px = 0, height_px = 0;
    std::vector<std::uint8_t> rgb;
};

/// Pictures from left to right, a little apart, their upper edges in line. Throws
/// std::invalid_argument for none at all.
Picture besideEachOther(const std::vector<Picture>& pictures);

/// The bytes of a PNG file. Throws std::invalid_argument if the picture is empty or `rgb`
/// is not of its size.
std::string pngOf(const Picture& picture);

/// Throws std::runtime_error naming the file if it cannot be written, and like pngOf.
void writePng(const Picture& picture, const std::string& file);

/// RFC 4648, padded, without line breaks.
std::string base64(const std::string& bytes);

}  // namespace hgmm::evaluation
