#pragma once
#include <string>

namespace hgmm::evaluation {

/// Text as the content of an element, or a quoted attribute, of HTML or SVG.
std::string escaped(const std::string& text);

/// A number as text, as printf would have it: formatted("%.3f", 0.5).
std::string formatted(const char* pattern, double value);

}  // namespace hgmm::evaluation
