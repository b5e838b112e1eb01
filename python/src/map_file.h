#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace hgmm::python {

/// Throws std::filesystem::filesystem_error for a file that cannot be read.
std::vector<std::uint8_t> readFile(const std::filesystem::path& file);
/// Writes a temporary file beside the target and renames it: a file that cannot be written
/// completely leaves the old one in place. Throws std::filesystem::filesystem_error.
void writeFile(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes);

bool isGzip(const std::vector<std::uint8_t>& bytes);
/// Throws FormatError for a stream that is damaged, lost its end or has more behind it.
std::vector<std::uint8_t> gunzipped(const std::vector<std::uint8_t>& bytes);
std::vector<std::uint8_t> gzipped(const std::vector<std::uint8_t>& bytes);

}  // namespace hgmm::python
