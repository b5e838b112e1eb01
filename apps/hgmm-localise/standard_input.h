#pragma once
#include <array>
#include <cstddef>
#include <string>

namespace localise {

/// Bytes from stdin. Ctrl-C ends a wait for them.
class StandardInput {
 public:
    /// Reads so many bytes. Returns how many: fewer at the end, or after Ctrl-C.
    /// Throws std::runtime_error where stdin cannot be read.
    std::size_t read(void* to, std::size_t bytes);
    /// Reads a line of at most so many bytes, its end included. What is returned has no
    /// end where the line is longer, or the input stops.
    std::string readLine(std::size_t mostBytes);

 private:
    bool fill();

    std::array<char, 1 << 16> buffer_{};
    std::size_t begin_ = 0, end_ = 0;  // of what is not read yet
};

}  // namespace localise
