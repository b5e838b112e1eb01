#pragma once
#include <string>
#include <vector>

namespace hgmm::evaluation {

/// The numbers in a text, parted by blanks. Throws std::runtime_error("'word' is not a
/// finite number") at the first word that is none.
std::vector<double> parseNumbers(const std::string& text);

}  // namespace hgmm::evaluation
