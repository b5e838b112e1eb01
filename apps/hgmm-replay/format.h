#pragma once
#include <string>

namespace replay {

/// printf into a string; lines of tables, cut at 255 characters.
__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...);

}  // namespace replay
