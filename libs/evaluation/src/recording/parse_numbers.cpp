#include "hgmm/evaluation/parse_numbers.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace hgmm::evaluation {

std::vector<double> parseNumbers(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        if (*end != '\0' || !std::isfinite(value))
            throw std::runtime_error("'" + word + "' is not a finite number");
        numbers.push_back(value);
    }
    return numbers;
}

}  // namespace hgmm::evaluation
