#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace import_test {

/// The header of a PCD file of n points.
inline std::string pcdHeader(const std::string& fields, const std::string& sizes,
                             const std::string& types, const std::string& counts,
                             std::size_t n, const std::string& data,
                             const std::string& viewpoint = "0 0 0") {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields +
           "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " +
           std::to_string(n) + "\nHEIGHT 1\nVIEWPOINT " + viewpoint + " 1 0 0 0\nPOINTS " +
           std::to_string(n) + "\nDATA " + data + "\n";
}

/// An ascii file of x y z.
inline std::string asciiPcd(std::size_t n, const std::string& lines,
                            const std::string& viewpoint = "0 0 0") {
    return pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", n, "ascii", viewpoint) + lines;
}

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The data of a binary_compressed file: both sizes, then the LZF block.
inline std::string compressedData(const std::string& block, std::size_t unpackedSize) {
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(block.size()));
    append(bytes, static_cast<std::uint32_t>(unpackedSize));
    return bytes + block;
}

/// LZF's literal run of up to 32 bytes.
inline std::string lzfLiteral(const std::string& bytes) {
    return static_cast<char>(bytes.size() - 1) + bytes;
}

/// LZF's repetition of 9 to 264 bytes that began distance bytes ago.
inline std::string lzfRepetition(std::size_t length, std::size_t distance) {
    return {static_cast<char>((7U << 5) | ((distance - 1) >> 8)),
            static_cast<char>(length - 9), static_cast<char>((distance - 1) & 255)};
}

}  // namespace import_test
